// The scene in 3D: its surfaces, the free space that was carved, the trajectory with the frustum of every view, the points of a frame.
// What is under the cursor is named, and a click keeps its instance marked. The camera is in the address.

import { getBytes } from "../shared/api.js";
import { byId, el } from "../shared/dom.js";
import { readGeometry } from "../shared/stage3d/geometry.js";
import { Stage3d } from "../shared/stage3d/stage.js";
import { say } from "../shared/say.js";
import { themeColor } from "../shared/theme.js";
import { toast, toastError } from "../shared/toast.js";
import { BufferAttribute, BufferGeometry, Group, Line, LineBasicMaterial, LineSegments, Points, PointsMaterial, Vector3 } from "../vendor/three.js";
import { idColor } from "./colors.js";
import { BOX_EDGES, boxCorners } from "./project.js";
import { placesOf, spanWords, withPlace } from "./ruler.js";
import { spaceControls } from "./space_controls.js";
import { framePoints } from "./space_points.js";
import { placeOf, viewOf } from "./space_view.js";

/** @typedef {import("./session.js").Session} Session */
/** @typedef {import("./space_controls.js").SpacePart} SpacePart */

/** Length of a drawn frustum, metres. */
const FRUSTUM_M = 0.28;
/** Maximum number of points of a frame. */
const POINTS = 150_000;
/** Maximum distance of a click from a camera, CSS pixels. */
const REACH_PX = 14;

/** The address follows the camera when it has rested for this long. */
const REST_MS = 300;
/** Windows narrower than this have the panel folded at first, CSS pixels. */
const NARROW_PX = 900;

export class Space {
    /** @param {Session} session */
    constructor(session) {
        this.session = session;
        this.element = byId("space");
        /** @type {Stage3d | null} */
        this.stage = null;
        /** @type {Record<SpacePart, boolean>} */
        this.on = { surfaces: true, points: true, views: true, boxes: false, free: false, occupied: false };
        /** @type {Partial<Record<SpacePart, Group>>} */
        this.groups = {};
        this.coloring = "class";
        /** True when somebody has chosen the colours; else they are of what the scene has. */
        this.isColoringChosen = false;
        this.above = false;
        /** The camera is the frame's, or on its way there. */
        this.atFrame = true;
        /** What the address says of the camera. */
        this.written = "";
        /** Where the pointer was last, CSS pixels of the view. @type {[number, number] | null} */
        this.pointer = null;
        /** What is measured, drawn over everything. @type {Group | null} */
        this.measured = null;
        /** Keys of what is shown, so that nothing is fetched or made twice. */
        this.shown = { scene: "", trajectory: "", frame: "", space: "" };
    }

    /** Shows what the state says, when it asks for 3D. */
    async show() {
        const { state } = this.session.store;
        const wanted = state.mode === "space";
        this.element.hidden = !wanted;
        if (!wanted || !this.session.scene) return;
        // If one kind of thing cannot be loaded, the others are shown all the same.
        for (const part of [() => this.stage ?? this.#begin(), () => this.#surfaces(), () => this.#trajectory(), () => this.#points(), () => this.#cubes(), () => this.ruler()]) {
            try {
                await part();
            } catch (error) {
                toastError(error);
            }
        }
    }

    #begin() {
        const view = el("div", { style: "position:absolute;inset:0", tabIndex: 0, role: "application", "aria-label": "The scene in 3D" });
        this.label = el("output", { class: "space-label panel", "aria-live": "off" });
        this.panel = el("div", { class: "space-panel" });
        this.span = el("output", { class: "space-span panel", "aria-live": "off" });
        this.element.replaceChildren(view, this.panel, this.span, this.label);
        this.stage = new Stage3d(view);
        this.theme();
        this.#choices();
        // The pictures below must not react to what is done here.
        for (const name of ["pointerdown", "pointermove", "pointerup", "wheel", "dblclick"]) this.element.addEventListener(name, (/** @type {Event} */ event) => event.stopPropagation());
        view.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
            if (!this.stage?.controls.key(event)) return;
            this.atFrame = false;
            event.stopPropagation();
        });
        view.addEventListener("wheel", () => (this.atFrame = false), { capture: true, passive: true });
        /** @type {{ x: number, y: number } | null} */
        let pressed = null;
        view.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => (pressed = { x: event.clientX, y: event.clientY }), true);
        view.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
            if (!pressed) this.#hover(event);
            else if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) >= 4) this.atFrame = false;
        }, true);
        view.addEventListener("pointerup", (/** @type {PointerEvent} */ event) => {
            if (pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < 4) this.#choose(event);
            pressed = null;
        }, true);
        view.addEventListener("pointerleave", () => {
            this.pointer = null;
            this.#name(-1);
        });
        this.stage.addEventListener("camera", () => this.#later());
    }

    /** Writes the camera into the address when it has come to rest. */
    #later() {
        clearTimeout(this.writing);
        this.writing = setTimeout(() => {
            if (!this.stage || this.element.hidden || this.stage.flight) return;
            this.written = this.atFrame ? "" : viewOf(this.stage, this.above);
            this.session.store.set({ view: this.written }, { step: false });
        }, REST_MS);
    }

    /** Goes where the address says, unless that is where the camera is. */
    look(instant = false) {
        const { view } = this.session.store.state;
        if (!this.stage || (view === this.written && !instant)) return;
        this.written = view;
        const place = placeOf(view);
        if (!place) return this.toFrame(instant);
        this.atFrame = false;
        this.above = place.above;
        this.#visibility();
        this.stage.goTo(place.camera, { instant });
        this.stage.controls.lookAt.set(...place.target);
    }

    /** Puts an end of the distance at the surface under the cursor. */
    measure() {
        const place = this.pointer && this.stage?.mesh ? this.stage.pointAt(...this.pointer) : null;
        if (!place) return toast("Point at a surface to measure.", "J begins there, and J at another ends there.");
        const span = withPlace(this.session.store.state.span, place.toArray());
        this.session.store.set({ span, tab: "display" });
        say(spanWords(span));
    }

    /** Shows what is measured. */
    ruler() {
        const { span } = this.session.store.state;
        const places = placesOf(span);
        this.measured?.traverse((object) => /** @type {any} */ (object).geometry?.dispose());
        this.measured?.removeFromParent();
        this.measured = null;
        if (this.span) this.span.textContent = places.length > 0 ? spanWords(span) : "";
        if (places.length > 0 && this.stage) {
            const shape = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(places.flat()), 3));
            const look = { color: 0xffdc5a, depthTest: false, transparent: true };
            this.measured = new Group().add(new Line(shape, new LineBasicMaterial(look)), new Points(shape, new PointsMaterial({ ...look, size: 9, sizeAttenuation: false })));
            this.stage.scene.add(this.measured);
        }
        this.stage?.requestFrame();
    }

    theme() {
        this.stage?.setTheme({ background: themeColor("--ground"), accent: themeColor("--accent"), paint: themeColor("--warn") });
        this.stage?.renderer.setClearColor(themeColor("--ground"));
    }

    #choices() {
        const open = /** @type {HTMLDetailsElement | null} */ (this.panel?.querySelector("details"))?.open ?? innerWidth >= NARROW_PX;
        this.panel?.replaceChildren(spaceControls(this, open));
    }

    /** Shows a kind of thing, or hides it. @param {SpacePart} part @param {boolean} on */
    turn(part, on) {
        this.on[part] = on;
        this.#visibility();
        this.show();
    }

    /** Colours the surfaces. @param {string} coloring */
    color(coloring) {
        this.coloring = coloring;
        this.isColoringChosen = true;
        this.#colors();
    }

    /** The canvas of what is shown, painted in this moment. */
    painting() {
        this.stage?.drawPicture();
        return this.stage ? [this.stage.canvas] : [];
    }

    /** Looks through the camera of the frame. */
    toFrame(instant = false) {
        this.above = false;
        this.atFrame = true;
        this.#visibility();
        const { camera, store } = this.session;
        const pose = camera?.frames.find((one) => one.frame === store.state.frame)?.pose;
        if (!pose || !this.stage) return;
        const { width = 1024, height = 768, fov_y_deg = 60 } = camera?.projection ?? {};
        this.stage.goTo({ ...pose, fov_y_deg: Math.min(fov_y_deg ?? 60, 120), width, height }, { instant });
    }

    /** Looks down at the whole scene, with the ceilings off. */
    fromAbove() {
        const { stage } = this;
        const places = (this.session.camera?.frames ?? []).flatMap(({ pose }) => (pose ? [pose.position] : []));
        const bounds = stage?.mesh?.geometry ?? { min: lowest(places), max: lowest(places.map((p) => p.map((v) => -v))).map((v) => -v) };
        if (!stage || !places.length) return;
        this.above = true;
        this.atFrame = false;
        this.#visibility();
        const [x, y, z] = [0, 1, 2].map((axis) => (bounds.min[axis] + bounds.max[axis]) / 2);
        const wide = Math.max(4, bounds.max[0] - bounds.min[0], bounds.max[1] - bounds.min[1]);
        // From the south and steeply: a plan that still shows heights.
        const [s, c] = [Math.sin(1.1), Math.cos(1.1)];
        const far = 1.05 * wide;
        stage.goTo({ position: [x, y - c * far, z + s * far], orientation: [1, 0, 0, 0, s, -c, 0, c, s], fov_y_deg: 55, width: 1024, height: 768 });
        // Orbiting turns about the middle of the scene.
        stage.controls.lookAt.set(x, y, z);
    }

    async #surfaces() {
        const { scene } = this.session;
        if (!scene || !this.stage || this.shown.scene === scene.name) return;
        this.shown = { scene: scene.name, trajectory: "", frame: "", space: "" };
        for (const part of Object.keys(this.groups)) this.#replace(/** @type {SpacePart} */ (part), []);
        this.stage.clear();
        // Beside surfaces the points of one frame are a choice; without them they are all there is.
        this.on.points = !scene.has_geometry;
        const { semantic, instance } = scene.objects;
        if (!this.isColoringChosen) this.coloring = semantic.some((id) => id > 0) ? "class" : instance.some((id) => id > 0) ? "instance" : "part";
        this.#choices();
        this.look(true);
        if (!scene.has_geometry) return;
        const buffer = await getBytes(`../api/view/scene/${encodeURIComponent(scene.name)}/geometry`);
        if (this.shown.scene !== scene.name) return;
        this.stage.setGeometry(readGeometry(buffer));
        this.#colors();
        this.#visibility();
        this.#marks();
        // The view from above was asked for before the size of the scene was known.
        if (this.above && !this.session.store.state.view) this.fromAbove();
    }

    /** The colours of the objects, by what is chosen. */
    #colors() {
        const pieces = this.stage?.mesh?.geometry.pieces;
        const { scene, looks } = this.session;
        if (!pieces || !scene) return;
        const rgb = new Uint8Array(3 * pieces);
        for (let i = 0; i < pieces; i++) {
            const semantic = scene.objects.semantic[i] ?? -1, instance = scene.objects.instance[i] ?? -1;
            const color = { class: semantic > 0 ? looks.color("semantic", semantic) : null, instance: instance > 0 ? looks.color("semantic_instance", instance) : null, part: idColor(i + 1) }[this.coloring];
            rgb.set(color ?? [190, 190, 190], 3 * i);
        }
        this.stage?.setPieceColors(rgb);
    }

    #visibility() {
        const pieces = this.stage?.mesh?.geometry.pieces ?? 0;
        const { scene, looks } = this.session;
        const ceiling = (/** @type {number} */ i) => [looks.className(scene?.objects.semantic[i] ?? -1), scene?.objects.names[i] ?? ""].some((name) => /ceiling/i.test(name));
        if (pieces) this.stage?.setVisibility(Array.from({ length: pieces }, (_, i) => i).filter((i) => !this.on.surfaces || (this.above && ceiling(i))), []);
        for (const [part, group] of Object.entries(this.groups)) group.visible = this.on[/** @type {SpacePart} */ (part)];
        this.stage?.requestFrame();
    }

    /** @param {SpacePart} part @param {import("../vendor/three.js").Object3D[]} objects */
    #replace(part, objects) {
        const old = this.groups[part];
        old?.traverse((object) => /** @type {any} */ (object).geometry?.dispose());
        old?.removeFromParent();
        const group = new Group();
        if (objects.length) group.add(...objects);
        group.visible = this.on[part];
        this.groups[part] = group;
        this.stage?.scene.add(group);
        this.stage?.requestFrame();
    }

    #trajectory() {
        const { camera, scene, store, looks } = this.session;
        this.#marks();
        const key = JSON.stringify([scene?.name, camera?.name, store.state.frame, store.state.instance]);
        if (!camera || this.shown.trajectory === key) return;
        this.shown.trajectory = key;
        const lines = (/** @type {number[]} */ places, /** @type {number} */ color, type = LineSegments) =>
            new type(new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(places), 3)), new LineBasicMaterial({ color }));
        const poses = camera.frames.filter((frame) => frame.pose);
        const frusta = (/** @type {import("./catalogue.js").CameraFrame[]} */ frames, scale = 1) => frames.flatMap(({ pose }) => {
            const r = /** @type {import("./catalogue.js").Pose} */ (pose);
            const rays = camera.projection?.corner_rays ?? [[-0.5, 0.4, -1], [0.5, 0.4, -1], [0.5, -0.4, -1], [-0.5, -0.4, -1]];
            const far = rays.map((ray) => [0, 1, 2].map((row) => r.position[row] + scale * FRUSTUM_M * (r.orientation[3 * row] * ray[0] + r.orientation[3 * row + 1] * ray[1] + r.orientation[3 * row + 2] * ray[2])));
            return far.flatMap((corner, i) => [...r.position, ...corner, ...corner, ...far[(i + 1) % 4]]);
        });
        const of = (/** @type {(frame: import("./catalogue.js").CameraFrame) => boolean} */ test) => poses.filter(test);
        const rejected = (/** @type {import("./catalogue.js").CameraFrame} */ frame) => frame.faults.some((fault) => fault.rejects);
        this.#replace("views", [
            lines(poses.flatMap(({ pose }) => pose?.position ?? []), 0x8fa3bf, /** @type {any} */ (Line)),
            lines(frusta(of((frame) => !rejected(frame) && frame.frame !== store.state.frame)), 0x8fa3bf),
            lines(frusta(of(rejected)), 0xe05a5c),
            lines(frusta(of((frame) => frame.frame === store.state.frame), 1.6), 0xffb833),
        ]);
        const boxes = (scene?.objects.instance ?? []).filter((id, i, all) => id > 0 && all.indexOf(id) === i);
        this.#replace("boxes", boxes.flatMap((id) => {
            const box = looks.box(id);
            if (!box) return [];
            const corners = boxCorners(box);
            const [r, g, b] = id === store.state.instance ? [255, 184, 51] : looks.color("semantic_instance", id);
            return [lines(BOX_EDGES.flatMap(([from, to]) => [...corners[from], ...corners[to]]), (r << 16) | (g << 8) | b)];
        }));
    }

    async #points() {
        const { scene, camera, store } = this.session;
        const place = `${scene?.name}/${camera?.name}/${store.state.frame}`;
        if (!this.on.points || !camera || this.shown.frame === place || !this.session.layersOf(store.state.frame).includes("depth_meters")) return;
        this.shown.frame = place;
        const buffer = await getBytes(`../api/view/points/${place.split("/").map(encodeURIComponent).join("/")}?most=${POINTS}`);
        if (this.shown.frame !== place) return;
        const pose = camera.frames.find((one) => one.frame === store.state.frame)?.pose;
        const { width = 1024, height = 768, fov_y_deg } = camera.projection ?? {};
        const step = Math.ceil(Math.sqrt(Math.ceil((width * height) / POINTS)));
        const pixel = (step * 2 * Math.tan((Math.min(fov_y_deg ?? 60, 150) * Math.PI) / 360)) / height;
        this.#replace("points", [framePoints(buffer, pose?.position ?? [0, 0, 0], { pixel, columns: Math.ceil(width / step) })]);
    }

    async #cubes() {
        const { scene } = this.session;
        if (!scene?.has_space || (!this.on.free && !this.on.occupied) || this.shown.space === scene.name) return;
        this.shown.space = scene.name;
        const buffer = await getBytes(`../api/view/scene/${encodeURIComponent(scene.name)}/space`);
        if (this.shown.scene !== scene.name) return;
        const header = new DataView(buffer);
        const free = header.getUint32(12, true), occupied = header.getUint32(16, true);
        const cubes = new Float32Array(buffer, 24, 4 * (free + occupied));
        this.#replace("free", cubeMiddles(cubes.subarray(0, 4 * free), 0x5aa9ff, 0.3));
        this.#replace("occupied", cubeMiddles(cubes.subarray(4 * free), 0xe5b567, 0.9));
    }

    /** Goes to the view whose camera was clicked, else marks the instance under the cursor. @param {PointerEvent} event */
    #choose(event) {
        const { stage } = this;
        if (!stage) return;
        const frame = this.on.views ? this.#cameraAt(event) : -1;
        if (frame >= 0) return this.session.store.set({ frame });
        const id = Math.max(0, this.session.scene?.objects.instance[this.#pieceAt(event)] ?? 0);
        this.session.store.set({ instance: id === this.session.store.state.instance ? 0 : id });
    }

    /** The frame whose camera is under the cursor; -1 for none. @param {PointerEvent} event */
    #cameraAt(event) {
        const box = this.element.getBoundingClientRect();
        let best = { frame: -1, far: REACH_PX };
        for (const { frame, pose, layers } of this.session.camera?.frames ?? []) {
            if (!pose || !layers.length || !this.stage) continue;
            const p = new Vector3(...pose.position).project(this.stage.camera);
            if (p.z > 1) continue;
            const far = Math.hypot(((p.x + 1) / 2) * box.width - (event.clientX - box.left), ((1 - p.y) / 2) * box.height - (event.clientY - box.top));
            if (far < best.far) best = { frame, far };
        }
        return best.frame;
    }

    /** The object under the cursor; -1 for none. @param {MouseEvent} event */
    #pieceAt(event) {
        const { left, top } = this.element.getBoundingClientRect();
        return this.stage?.mesh ? this.stage.seenAt(event.clientX - left, event.clientY - top).piece : -1;
    }

    /** @param {PointerEvent} event */
    #hover(event) {
        const { left, top } = this.element.getBoundingClientRect();
        this.pointer = [event.clientX - left, event.clientY - top];
        if (this.looking) return;
        // Once per picture of the screen: reading from the graphics card takes a while.
        this.looking = requestAnimationFrame(() => {
            this.looking = 0;
            this.#name(this.#pieceAt(event));
        });
    }

    /** Names an object and lights it up. @param {number} piece -1 for none */
    #name(piece) {
        const { scene, looks } = this.session;
        this.stage?.setHovered(piece);
        const instance = scene?.objects.instance[piece] ?? -1;
        const words = piece < 0 ? [] : [scene?.objects.names[piece] ?? "", looks.className(scene?.objects.semantic[piece] ?? -1), instance > 0 ? `instance ${instance}` : ""];
        if (this.label) this.label.textContent = words.filter(Boolean).join(" · ");
    }

    /** The instance that is marked stands out. */
    #marks() {
        const { scene, store } = this.session;
        const wanted = store.state.instance;
        if (this.stage?.mesh) this.stage.setMarks((scene?.objects.instance ?? []).flatMap((id, piece) => (wanted > 0 && id === wanted ? [piece] : [])));
    }
}

/** The minimum of each coordinate. @param {number[][]} points */
const lowest = (points) => [0, 1, 2].map((axis) => Math.min(...points.map((point) => point[axis])));

/** A point in the middle of each cube, as large as a part of it. @param {Float32Array} cubes x, y, z, edge @param {number} color @param {number} share */
function cubeMiddles(cubes, color, share) {
    /** @type {Map<number, number[]>} */
    const byEdge = new Map();
    for (let i = 0; i < cubes.length; i += 4) {
        const edge = cubes[i + 3];
        const places = byEdge.get(edge) ?? [];
        if (!places.length) byEdge.set(edge, places);
        places.push(cubes[i] + edge / 2, cubes[i + 1] + edge / 2, cubes[i + 2] + edge / 2);
    }
    return [...byEdge].map(([edge, places]) =>
        new Points(new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(places), 3)), new PointsMaterial({ color, size: edge * share, transparent: true, opacity: 0.55, depthWrite: false })));
}
