// The 3D view of a scene, for every page that shows one.
//
//     const stage = new Stage3d(element);
//     stage.setGeometry(readGeometry(await getBytes("/api/annotate/geometry")));
//     stage.setPieceColors(rgb);
//     stage.goTo(camera, { instant: true });
//     stage.scene.add(new LineSegments(…));   // anything of three.js: it is drawn with the scene's depth
//     stage.requestFrame();
//
// It draws only when something has changed. While the camera moves it draws as many faces as the machine can at a good rate, the large
// ones first; at rest it draws all. World: metres, z up. Pixels count from the upper left corner of the element, in CSS pixels.

import { Color, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from "../../vendor/three.js";
import { cameraJson, fittingFov, forward, lookingAt, rotation } from "./camera.js";
import { Controls } from "./controls.js";
import { Flight, motionReduced } from "./flight.js";
import { SceneMesh } from "./mesh.js";
import { Pace } from "./pace.js";
import { Photograph } from "./photograph.js";
import { NONE, Picture, SeenTarget } from "./picture.js";
import { hitPoint, seenAt, seenIn } from "./probe.js";
import { Refinement } from "./refine.js";
import { HIDDEN, PREVIEWED, SELECTED, XRAY } from "./shaders.js";
import { HATCHING, Tables } from "./tables.js";

/** Distance of the point that orbiting turns about, and that the wheel goes toward, from a camera that was gone to, metres. */
const AHEAD_M = 2;
/** Minimum distance of the near plane from the camera, metres. */
const NEAR_M = 0.05;
/** Distance of the far plane if there are no faces, metres. */
const FAR_M = 100;
/** How far the wheel takes the camera from the middle of a scene, in diagonals of it. */
const FARTHEST = 2;
/** The camera is at rest when it has not moved for this long, milliseconds. */
const SETTLE_MS = 140;
/** Frames that are further apart than this, milliseconds, belong to two motions. */
const LONGEST_FRAME_MS = 600;
/** Maximum number of samples of a picture at rest that is drawn finer than its pixels. */
const MAX_SAMPLES = 9_000_000;

/**
 * Events: `camera` after each change of the camera, `settled` when a picture of all faces is shown, `lost` when the browser has taken the
 * graphics away.
 */
export class Stage3d extends EventTarget {
    /**
     * @param {HTMLElement} element the view fills it; it should be focusable and have a label
     * @throws {Error} when the browser has no WebGL 2
     */
    constructor(element) {
        super();
        this.element = element;
        const canvas = document.createElement("canvas");
        canvas.style.cssText = "display:block;width:100%;height:100%;touch-action:none";
        canvas.setAttribute("aria-hidden", "true");
        element.append(canvas);
        this.canvas = canvas;
        const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, powerPreference: "high-performance" });
        if (!gl) throw new Error("This browser has no WebGL 2, which the 3D view needs. Allow hardware acceleration in its settings, or use a current Firefox, Chrome, Edge or Safari.");
        this.gl = gl;
        this.renderer = new WebGLRenderer({ canvas, context: gl });
        this.renderer.autoClear = false;
        /** Name of the graphics hardware or driver. */
        this.graphics = String(gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
        /** True when there is no graphics hardware and the CPU draws. */
        this.software = /swiftshader|llvmpipe|software|basic render/i.test(this.graphics);
        /** What pages draw beside the scene: lines, points, boxes. Call {@link requestFrame} after a change. */
        this.scene = new Scene();
        /** The camera of the view. Call {@link cameraMoved} after setting it. */
        this.camera = new PerspectiveCamera(60, 1, NEAR_M, FAR_M);
        this.camera.up.set(0, 0, 1);
        /** Finer than pixels at rest: null decides by the machine. @type {boolean | null} */
        this.smooth = null;
        this.tables = new Tables(1);
        this.picture = new Picture(this.tables);
        this.quick = new SeenTarget(1);
        this.fine = new SeenTarget(1);
        this.shown = this.quick;
        this.refinement = new Refinement(this.renderer, this.fine);
        this.pace = new Pace(0, this.software);
        this.controls = new Controls(element, this.camera, () => this.cameraMoved());
        /** @type {SceneMesh | null} */
        this.mesh = null;
        /** The box outside of which nothing is shown, metres. @type {{ min: number[], max: number[] } | null} */
        this.clip = null;
        this.photograph = new Photograph();
        /** @type {Flight | null} */
        this.flight = null;
        /** Counts for read-outs: frames drawn while moving, time between them, time of the last whole picture. */
        this.counts = { frames: 0, movedMs: 0, drawnFaces: 0 };
        this.scheduled = false;
        this.stale = true;
        this.pictureStale = true;
        this.told = false;
        this.lastChange = -Infinity;
        /** True when the camera has moved since the last drawing. */
        this.moved = false;
        this.lastMotionFrame = -Infinity;
        this.lastFrame = 0;
        this.settleTimer = 0;
        this.resizes = new ResizeObserver(() => this.resize());
        this.resizes.observe(element);
        canvas.addEventListener("webglcontextlost", () => this.dispatchEvent(new Event("lost")));
        canvas.addEventListener("webglcontextrestored", () => this.meshChanged());
        this.resize();
    }

    // What is shown.

    /** Shows a scene, in white. @param {import("./geometry.js").Geometry} geometry */
    setGeometry(geometry) {
        this.tables.dispose();
        this.tables = new Tables(geometry.pieces);
        this.picture.tables = this.tables;
        this.completeGeometry(geometry);
    }

    /** Shows the scene that is shown with more of its faces; colours and marks stay. @param {import("./geometry.js").Geometry} geometry */
    completeGeometry(geometry) {
        const wireframe = this.mesh?.shared.wireframe.value ?? false;
        this.mesh?.dispose();
        this.tables.grow(geometry.pieces);
        this.mesh = new SceneMesh(geometry, this.tables);
        this.mesh.shared.wireframe.value = wireframe;
        this.mesh.setClip(this.clip);
        const { fixed } = this.pace;
        this.pace = new Pace(geometry.faces, this.software);
        this.pace.fixed = fixed;
        const diagonal = new Vector3(...geometry.max).distanceTo(new Vector3(...geometry.min));
        this.controls.bound(new Vector3(...geometry.min).add(new Vector3(...geometry.max)).multiplyScalar(0.5), diagonal * FARTHEST);
        this.camera.far = Math.max(10, diagonal * (FARTHEST + 1));
        this.meshChanged();
    }

    /** Shows no faces, until the next scene. */
    clear() {
        this.mesh?.dispose();
        this.mesh = null;
        this.quick.dispose();
        this.fine.dispose();
        this.controls.bound(new Vector3(), Infinity);
        this.camera.far = FAR_M;
        this.meshChanged();
    }

    /** Colours of all pieces. @param {Uint8Array} rgb three values per piece, sRGB 0..255 @param {Uint8Array} [hatched] how each piece is hatched */
    setPieceColors(rgb, hatched) {
        this.tables.grow(rgb.length / 3);
        const { colors } = this.tables;
        for (let i = 0, j = 0; i < rgb.length; i += 3, j += 4) colors.set([rgb[i], rgb[i + 1], rgb[i + 2], HATCHING[hatched?.[i / 3] ?? 0]], j);
        this.tables.colorTexture.needsUpdate = true;
        this.requestFrame();
    }

    /**
     * Which pieces are not drawn, and which are seen through.
     *
     * @param {Iterable<number>} hidden pieces
     * @param {Iterable<number>} xray pieces
     */
    setVisibility(hidden, xray) {
        const { flags } = this.tables;
        flags.fill(0);
        for (const piece of xray) flags[piece] |= XRAY;
        for (const piece of hidden) flags[piece] |= HIDDEN;
        this.tables.flagTexture.needsUpdate = true;
        this.meshChanged();
    }

    /**
     * Which pieces stand out.
     *
     * @param {Iterable<number>} selected
     * @param {Iterable<number>} [previewed] what a stroke would select
     */
    setMarks(selected, previewed = []) {
        const { marks } = this.tables;
        marks.fill(0);
        for (const piece of selected) marks[piece] |= SELECTED;
        for (const piece of previewed) marks[piece] |= PREVIEWED;
        this.tables.markTexture.needsUpdate = true;
        this.picture.uniforms.anyMarked.value = marks.some((one) => one !== 0);
        this.requestFrame();
    }

    /** Lights up the piece under the pointer. @param {number} piece -1 for none */
    setHovered(piece) {
        const value = piece < 0 ? NONE : piece;
        if (this.picture.uniforms.hovered.value === value) return;
        this.picture.uniforms.hovered.value = value;
        this.requestFrame();
    }

    /** Paints these faces, and no other. @param {Set<number>} faces scene face numbers; none gives the memory back */
    setPaintedFaces(faces) {
        if (!this.mesh) return;
        if (faces.size === 0) this.tables.unmarkFaces();
        else this.tables.markFaces(faces, [...faces].reduce((most, face) => Math.max(most, face + 1), this.mesh.geometry.faces));
        this.requestFrame();
    }

    /**
     * Moves faces to other pieces, after a split.
     *
     * @param {number[]} faces scene face numbers
     * @param {number[]} pieces the new piece of each
     */
    moveFaces(faces, pieces) {
        if (!this.mesh) return;
        this.tables.grow(pieces.reduce((most, piece) => Math.max(most, piece + 1), 0));
        this.mesh.shared.pieceFlags.value = this.tables.flagTexture;
        this.mesh.movePieces(faces, pieces);
        this.meshChanged();
    }

    /** Colours of the surroundings, of what is marked, and of painted faces. @param {{ background: string, accent: string, paint: string }} colors CSS colours */
    setTheme({ background, accent, paint }) {
        // The picture holds colours as they are shown; three.js would take them as light.
        const { uniforms } = this.picture;
        uniforms.background.value.copy(new Color(background)).convertLinearToSRGB();
        uniforms.accent.value.copy(new Color(accent)).convertLinearToSRGB();
        uniforms.paint.value.copy(new Color(paint)).convertLinearToSRGB();
        this.requestFrame();
    }

    /** Edges of all triangles. @param {boolean} on */
    setWireframe(on) {
        if (this.mesh) this.mesh.shared.wireframe.value = on;
        this.meshChanged();
    }

    /** Surfaces are shown as they look, instead of in the colours of their pieces. @param {boolean} on */
    setReal(on) {
        this.picture.uniforms.real.value = on;
        this.requestFrame();
    }

    /** How the faces look. @param {Uint8Array} rgb three values per face of the scene, sRGB 0..255 */
    setFaceColors(rgb) {
        this.tables.setFaceColors(rgb);
        this.requestFrame();
    }

    /** A photograph that is laid over what it shows. @param {HTMLImageElement | null} image @param {import("./camera.js").CameraJson & { aspect: number }} [camera] that took it */
    setPhotograph(image, camera) {
        if (image && camera && this.mesh) this.photograph.take(image, camera, this.renderer, this.mesh, this.tables);
        else this.photograph.dispose();
        this.requestFrame();
    }

    /** Dark lines between pieces. @param {boolean} on */
    setOutlines(on) {
        this.picture.uniforms.outlines.value = on;
        this.requestFrame();
    }

    // The camera.

    /**
     * Goes to a camera, and adopts its field of view so that all of its picture is in the window.
     *
     * @param {import("./camera.js").CameraJson} json
     * @param {{ instant?: boolean }} [options] instant: without a flight; also when the user wants less motion
     */
    goTo(json, { instant = false } = {}) {
        const to = { position: new Vector3(...json.position), quaternion: rotation(json.orientation), fov: fittingFov(json, this.camera.aspect) };
        this.controls.lookAt.copy(to.position).addScaledVector(forward(to.quaternion), AHEAD_M);
        if (!instant && !motionReduced()) {
            this.flight = new Flight(this.camera, to, performance.now());
        } else {
            this.flight = null;
            this.camera.position.copy(to.position);
            this.camera.quaternion.copy(to.quaternion);
            this.camera.fov = to.fov;
        }
        this.cameraMoved();
    }

    /** Shows a box from a direction, at such a distance that it fills a good part. @param {number[]} min @param {number[]} max @param {Vector3} back from the box to the camera */
    frameBox(min, max, back) {
        const center = new Vector3(...min).add(new Vector3(...max)).multiplyScalar(0.5);
        const radius = new Vector3(...max).distanceTo(new Vector3(...min)) / 2;
        const half = Math.min(1, this.camera.aspect) * Math.tan((this.camera.fov * Math.PI) / 360);
        this.flyTo(center.clone().addScaledVector(back, (radius * 1.05) / Math.sin(Math.atan(half))), center);
    }

    /** Goes to a place and looks at a point, which the camera then turns about. @param {Vector3} from @param {Vector3} to */
    flyTo(from, to) {
        this.controls.lookAt.copy(to);
        const pose = { position: from, quaternion: lookingAt(from, to), fov: this.camera.fov };
        this.flight = new Flight(this.camera, pose, motionReduced() ? -Infinity : performance.now());
        this.cameraMoved();
    }

    /** The camera of now as the server takes it; pixels are CSS pixels of the element. */
    cameraJson() {
        const json = cameraJson(this.camera, this.element.clientWidth, this.element.clientHeight, this.near);
        return this.clip === null ? json : { ...json, clip: this.clip };
    }

    /** What lies outside of a box is neither drawn nor picked. @param {{ min: number[], max: number[] } | null} box metres; null for no box */
    setClip(box) {
        this.clip = box && { min: box.min, max: box.max };
        this.mesh?.setClip(box);
        this.meshChanged();
    }

    /** What is nearer along the optical axis is neither drawn nor picked, metres. */
    get near() {
        return this.camera.near;
    }

    /** @param {number} near_m */
    setNear(near_m) {
        this.camera.near = Math.max(NEAR_M, near_m);
        this.camera.updateProjectionMatrix();
        this.cameraMoved();
    }

    /** To be called after `camera` was changed from outside. */
    cameraMoved() {
        this.lastChange = performance.now();
        this.moved = true;
        this.stale = true;
        this.requestFrame();
        this.dispatchEvent(new Event("camera"));
    }

    // What is seen.

    /**
     * What is seen at a pixel; pieces that are seen through are passed over where something is behind them.
     *
     * @param {number} x
     * @param {number} y
     * @returns {{ piece: number, face: number }} piece -1 and face -1 for nothing
     */
    seenAt(x, y) {
        return seenAt(this, x, y);
    }

    /** All pieces seen in a rectangle of pixels, as shown now. @param {number[]} rectangle x0, y0, x1, y1 @returns {Set<number>} */
    seenIn(rectangle) {
        return seenIn(this, rectangle);
    }

    /** Where the surface that is seen at a pixel lies, metres; null for nothing. @param {number} x @param {number} y */
    pointAt(x, y) {
        const { face } = seenAt(this, x, y);
        return face < 0 ? null : hitPoint(this, face, x, y);
    }

    // Drawing.

    /** Draws soon. Cheap: many calls make one frame. */
    requestFrame() {
        this.pictureStale = true;
        this.schedule();
    }

    /** One more turn; the picture is drawn again only if it has changed. */
    schedule() {
        if (this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame((now) => this.frame(now));
    }

    /** To be called when triangles look different although the camera has not moved. */
    meshChanged() {
        this.stale = true;
        this.requestFrame();
    }

    /** @param {number} now milliseconds */
    frame(now) {
        this.scheduled = false;
        this.moveOn(now);
        if (this.stale) this.drawQuick(now);
        const restsAt = this.lastChange + SETTLE_MS;
        if (this.controls.held.size > 0 || this.flight) {
            this.schedule();
        } else if (performance.now() < restsAt) {
            clearTimeout(this.settleTimer);
            this.settleTimer = setTimeout(() => this.schedule(), restsAt - performance.now() + 1);
        } else if (!this.refine()) {
            // The current picture stays until the finer one is complete.
            this.schedule();
        }
        if (this.pictureStale) this.drawPicture();
        this.lastFrame = now;
    }

    /** Flies on. @param {number} now */
    moveOn(now) {
        this.controls.fly((now - this.lastFrame) / 1000);
        if (!this.flight) return;
        if (this.flight.advance(now)) this.flight = null;
        this.cameraMoved();
    }

    /** Draws the first faces of display order, as many as keep a good rate. @param {number} now */
    drawQuick(now) {
        this.stale = false;
        this.told = false;
        this.refinement.restart();
        // Lines and points beside the scene need the camera's matrices too.
        this.camera.updateProjectionMatrix();
        this.camera.updateMatrixWorld();
        if (!this.mesh) return;
        const { moved } = this;
        this.moved = false;
        const since = now - this.lastMotionFrame;
        if (moved && since < LONGEST_FRAME_MS) {
            this.pace.frameTook(since);
            this.counts.frames++;
            this.counts.movedMs += since;
        }
        this.lastMotionFrame = moved ? now : -Infinity;
        const { renderer, camera, mesh } = this;
        mesh.shared.upInView.value.set(0, 0, 1).transformDirection(camera.matrixWorldInverse);
        const [width, height] = [this.canvas.width, this.canvas.height];
        const budget = this.pace.budget;
        renderer.setRenderTarget(this.quick.sized(width, height));
        renderer.clear();
        mesh.setRange(0, budget);
        renderer.render(mesh.scene, camera);
        renderer.setRenderTarget(null);
        this.counts.drawnFaces = budget;
        this.quick.complete = budget === mesh.geometry.faces;
        this.shown = this.quick;
    }

    /** Goes on with the picture of all faces. True when it is whole. */
    refine() {
        if (!this.mesh) return true;
        const [width, height] = [this.canvas.width, this.canvas.height];
        const finer = (this.smooth ?? !this.software) && width * height * 4 <= MAX_SAMPLES;
        const samples = finer ? 2 : 1;
        if (this.fine.samples !== samples) {
            this.fine.dispose();
            this.fine.samples = samples;
            this.refinement.restart();
        }
        if (!(this.fine.complete || (samples === 1 && this.quick.complete))) {
            if (!this.refinement.advance(this.mesh, this.camera, width, height)) return false;
            this.shown = this.fine;
            this.pictureStale = true;
        }
        if (!this.told) {
            this.told = true;
            this.dispatchEvent(new Event("settled"));
        }
        return true;
    }

    /** True when all faces are shown for the camera of now. */
    get settled() {
        return !this.stale && this.shown.complete;
    }

    drawPicture() {
        this.pictureStale = false;
        this.renderer.setRenderTarget(null);
        this.renderer.clear();
        if (this.shown.target) this.picture.draw(this.renderer, this.shown, this.camera, this.photograph);
        this.renderer.render(this.scene, this.camera);
    }

    resize() {
        const [width, height] = [Math.max(1, this.element.clientWidth), Math.max(1, this.element.clientHeight)];
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.meshChanged();
        this.dispatchEvent(new Event("camera"));
    }

    /** Frees memory and listeners. */
    dispose() {
        this.resizes.disconnect();
        this.controls.dispose();
        this.mesh?.dispose();
        this.tables.dispose();
        this.picture.dispose();
        this.photograph.dispose();
        this.quick.dispose();
        this.fine.dispose();
        this.renderer.dispose();
        this.canvas.remove();
    }
}
