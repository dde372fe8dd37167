// The scene in 3D: its surfaces, the free space that was carved, the trajectory with the frustum of every view, the points of a frame.

import { getBytes } from "../shared/api.js";
import { byId, el } from "../shared/dom.js";
import { readGeometry } from "../shared/stage3d/geometry.js";
import { Stage3d } from "../shared/stage3d/stage.js";
import { BufferAttribute, BufferGeometry, Color, Group, Line, LineBasicMaterial, LineSegments, Points, PointsMaterial, SRGBColorSpace, Vector3 } from "../vendor/three.js";
import { idColor } from "./colors.js";
import { showNotice } from "./notice.js";
import { BOX_EDGES, boxCorners } from "./project.js";

/** @typedef {import("./session.js").Session} Session */
/** @typedef {"surfaces" | "points" | "free" | "occupied" | "views" | "boxes"} SpacePart */

/** Length of a drawn frustum, metres. */
const FRUSTUM_M = 0.28;
/** Maximum number of points of a frame. */
const POINTS = 150_000;
/** Maximum distance of a click from a camera, CSS pixels. */
const REACH_PX = 14;

/** Linear light of each byte of sRGB, 0 to 1. */
const LIGHT = Float32Array.from({ length: 256 }, (_, value) => new Color().setRGB(value / 255, 0, 0, SRGBColorSpace).r);

/** @type {[SpacePart, string][]} */
const PARTS = [["surfaces", "Surfaces"], ["points", "Points of the frame"], ["views", "Trajectory and views"], ["boxes", "Boxes"], ["free", "Free space"], ["occupied", "Occupied space"]];

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
        this.above = false;
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
        for (const part of [() => this.stage ?? this.#begin(), () => this.#surfaces(), () => this.#trajectory(), () => this.#points(), () => this.#cubes()]) {
            try {
                await part();
            } catch (error) {
                showNotice(/** @type {Error} */ (error).message);
            }
        }
    }

    #begin() {
        const view = el("div", { style: "position:absolute;inset:0", tabIndex: 0, "aria-label": "The scene in 3D" });
        this.controls = el("div", { class: "space-controls panel" });
        this.element.replaceChildren(view, this.controls);
        this.stage = new Stage3d(view);
        this.theme();
        this.#choices();
        // The pictures below must not react to what is done here.
        for (const name of ["pointerdown", "pointermove", "pointerup", "wheel", "dblclick"]) this.element.addEventListener(name, (/** @type {Event} */ event) => event.stopPropagation());
        view.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
            if (this.stage?.controls.key(event)) event.stopPropagation();
        });
        /** @type {{ x: number, y: number } | null} */
        let pressed = null;
        view.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => (pressed = { x: event.clientX, y: event.clientY }), true);
        view.addEventListener("pointerup", (/** @type {PointerEvent} */ event) => {
            if (pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < 4) this.#choose(event);
            pressed = null;
        }, true);
    }

    theme() {
        const style = getComputedStyle(document.documentElement);
        const color = (/** @type {string} */ name) => style.getPropertyValue(name).trim();
        this.stage?.setTheme({ background: color("--ground"), accent: color("--accent"), paint: color("--warn") });
        this.stage?.renderer.setClearColor(color("--ground"));
    }

    #choices() {
        const { scene } = this.session;
        const missing = /** @type {Partial<Record<SpacePart, boolean>>} */ ({ surfaces: !scene?.has_geometry, free: !scene?.has_space, occupied: !scene?.has_space });
        const box = ([part, label] = PARTS[0]) => el("label", {}, el("input", { type: "checkbox", "data-part": part, checked: this.on[part] && !missing[part], disabled: !!missing[part],
            onchange: (/** @type {any} */ e) => {
                this.on[part] = e.target.checked;
                this.#visibility();
                this.show();
            } }), ` ${label}`);
        const colors = el("select", { "aria-label": "Colours of the surfaces", onchange: (/** @type {any} */ e) => {
            this.coloring = e.target.value;
            this.#colors();
        } }, ...[["class", "Colours of classes"], ["instance", "Colours of instances"], ["part", "Colours of parts"], ["plain", "White"]].map(([value, text]) => el("option", { value, selected: value === this.coloring }, text)));
        this.controls?.replaceChildren(...PARTS.map(box), colors, el("button", { type: "button", onclick: () => this.toFrame() }, "Through this frame's camera"), el("button", { type: "button", onclick: () => this.fromAbove() }, "From above"));
    }

    /** Looks through the camera of the frame. */
    toFrame(instant = false) {
        this.above = false;
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
        this.#visibility();
        const [x, y, z] = [0, 1, 2].map((axis) => (bounds.min[axis] + bounds.max[axis]) / 2);
        const wide = Math.max(4, bounds.max[0] - bounds.min[0], bounds.max[1] - bounds.min[1]);
        // From the south and steeply: a plan that still shows heights.
        const [s, c] = [Math.sin(1.1), Math.cos(1.1)];
        const far = 1.05 * wide;
        stage.goTo({ position: [x, y - c * far, z + s * far], orientation: [1, 0, 0, 0, s, -c, 0, c, s], fov_y_deg: 55, width: 1024, height: 768 });
    }

    async #surfaces() {
        const { scene } = this.session;
        if (!scene || !this.stage || this.shown.scene === scene.name) return;
        this.shown = { scene: scene.name, trajectory: "", frame: "", space: "" };
        for (const part of Object.keys(this.groups)) this.#replace(/** @type {SpacePart} */ (part), []);
        this.stage.clear();
        this.#choices();
        this.toFrame(true);
        if (!scene.has_geometry) return;
        const buffer = await getBytes(`../api/view/scene/${encodeURIComponent(scene.name)}/geometry`);
        if (this.shown.scene !== scene.name) return;
        this.stage.setGeometry(readGeometry(buffer));
        this.#colors();
        this.#visibility();
        // The view from above was asked for before the size of the scene was known.
        if (this.above) this.fromAbove();
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
        const count = new DataView(buffer).getUint32(8, true);
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(new Float32Array(buffer, 16, 3 * count), 3));
        // three.js takes linear light and converts it to sRGB.
        geometry.setAttribute("color", new BufferAttribute(Float32Array.from(new Uint8Array(buffer, 16 + 12 * count, 4 * count), (value) => LIGHT[value]), 4));
        this.#replace("points", [new Points(geometry, new PointsMaterial({ size: 2.2, sizeAttenuation: false, vertexColors: true, toneMapped: false }))]);
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

    /** Goes to the view whose camera was clicked. @param {PointerEvent} event */
    #choose(event) {
        const { stage } = this;
        if (!stage || !this.on.views) return;
        const box = this.element.getBoundingClientRect();
        let best = { frame: -1, far: REACH_PX };
        for (const { frame, pose, layers } of this.session.camera?.frames ?? []) {
            if (!pose || !layers.length) continue;
            const p = new Vector3(...pose.position).project(stage.camera);
            if (p.z > 1) continue;
            const far = Math.hypot(((p.x + 1) / 2) * box.width - (event.clientX - box.left), ((1 - p.y) / 2) * box.height - (event.clientY - box.top));
            if (far < best.far) best = { frame, far };
        }
        if (best.frame >= 0) this.session.store.set({ frame: best.frame });
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
