// The pointer on the view: strokes of pen, line, rectangle and eyedropper, selecting by click, and painting faces to split off.

import { postJson } from "../shared/api.js";
import { toast, toastError } from "../shared/toast.js";
import { byId } from "../shared/dom.js";
import { filtersOn, passes } from "./filters.js";

/** A press that moves less than this is a click, CSS pixels. */
const CLICK_PX = 4;
/** A stroke is looked up at about so many places, to say why it labelled nothing. */
const PLACES = 60;

/** What the pointer does on the view, beside moving the camera. */
export class Draw {
    /**
     * @param {import("../shared/stage3d/stage.js").Stage3d} stage
     * @param {import("./state.js").State} state
     * @param {{ newInstance: () => void, give: (action: any) => Promise<any>, hovered: (piece: number) => void }} hooks
     */
    constructor(stage, state, hooks) {
        this.stage = stage;
        this.state = state;
        this.hooks = hooks;
        /** @type {[number, number][] | null} */
        this.points = null;
        /** @type {[number, number] | null} */
        this.pressed = null;
        this.hoverQueued = false;
        this.at = [0, 0];
        const { element } = stage;
        stage.controls.claimed = (event) => this.claims(event);
        element.addEventListener("pointerdown", (event) => this.down(event));
        element.addEventListener("pointermove", (event) => this.move(event));
        element.addEventListener("pointerup", (event) => this.up(event));
        element.addEventListener("pointercancel", () => this.cancel());
        element.addEventListener("pointerleave", () => this.hover(-1));
        // What was under the pointer is somewhere else then.
        stage.addEventListener("camera", () => this.hover(-1));
        element.addEventListener("dblclick", (event) => this.lookHere(event));
    }

    /** True when a press draws. @param {PointerEvent} event */
    claims(event) {
        const draws = this.state.drawMode !== event.shiftKey || (this.state.painting !== null && !event.altKey);
        return (event.button === 0 && draws) || (event.button === 2 && event.shiftKey);
    }

    /** @param {PointerEvent} event @returns {[number, number]} */
    place(event) {
        const box = this.stage.element.getBoundingClientRect();
        /** @param {number} v @param {number} size */
        const inside = (v, size) => Math.min(Math.max(v, 0), size - 0.5);
        return [inside(event.clientX - box.left, box.width), inside(event.clientY - box.top, box.height)];
    }

    /** @param {PointerEvent} event */
    down(event) {
        this.stage.element.focus({ preventScroll: true });
        if (event.button === 2 && event.shiftKey) {
            this.hooks.newInstance();
            return;
        }
        if (event.button !== 0) return;
        const place = this.place(event);
        if (!this.claims(event)) {
            this.pressed = place;
            return;
        }
        this.stage.element.setPointerCapture(event.pointerId);
        this.points = [place];
        this.show();
    }

    /** @param {PointerEvent} event */
    move(event) {
        const place = this.place(event);
        this.at = place;
        if (this.points) {
            for (const one of event.getCoalescedEvents?.() ?? []) if (this.tool === "pen") this.points.push(this.place(one));
            this.points.push(place);
            if (this.tool !== "pen") this.points = [this.points[0], place];
            this.show();
            if (this.tool === "rectangle" && !this.state.painting) this.preview();
        } else if (event.buttons === 0 && !this.hoverQueued) {
            this.hoverQueued = true;
            requestAnimationFrame(() => {
                this.hoverQueued = false;
                if (!this.stage.controls.active && !this.stage.flight) this.hover(this.stage.seenAt(this.at[0], this.at[1]).piece);
            });
        }
    }

    /** @param {PointerEvent} event */
    up(event) {
        const place = this.place(event);
        if (this.points) {
            const points = this.points;
            this.cancel();
            void this.finish(points);
        } else if (this.pressed && Math.hypot(place[0] - this.pressed[0], place[1] - this.pressed[1]) < CLICK_PX) {
            this.click(place, event.ctrlKey || event.metaKey);
        }
        this.pressed = null;
    }

    /** Gives up the stroke that is being drawn; false if there is none. */
    giveUp() {
        const drawing = this.points !== null;
        this.cancel();
        return drawing;
    }

    cancel() {
        this.points = null;
        byId("strokes").replaceChildren();
        this.stage.setMarks(this.state.selection);
    }

    get tool() {
        return this.state.painting && this.state.tool === "eyedropper" ? "pen" : this.state.tool;
    }

    /** Selects what was clicked; with a modifier adds it or takes it out. @param {[number, number]} place @param {boolean} more */
    click(place, more) {
        const { piece } = this.stage.seenAt(...place);
        const selection = new Set(more ? this.state.selection : []);
        const isIn = selection.has(piece);
        for (const one of piece < 0 ? [] : this.state.grown(piece)) isIn ? selection.delete(one) : selection.add(one);
        this.state.select(selection);
    }

    /** Makes the double-clicked point the one that the camera turns about. @param {MouseEvent} event */
    lookHere(event) {
        const point = this.stage.pointAt(...this.place(/** @type {PointerEvent} */ (event)));
        if (!point || this.state.drawMode) return;
        this.stage.controls.lookAt.copy(point);
        this.stage.controls.aim();
    }

    /** @param {number} piece */
    hover(piece) {
        this.stage.setHovered(piece);
        this.hooks.hovered(piece);
    }

    /** The shape of these points, as the server takes it. @param {[number, number][]} points @returns {Record<string, any>} */
    shape(points) {
        const [first, last] = [points[0], points[points.length - 1]];
        if (Math.hypot(last[0] - first[0], last[1] - first[1]) < 1 && points.length < 3) return { click: first };
        if (this.tool === "rectangle") return { rectangle: [...first, ...last] };
        return this.tool === "line" ? { line: [first, last] } : { pen: points };
    }

    /** What the server needs to know of the view. */
    look() {
        return { camera: this.stage.cameraJson(), hidden: this.state.unseen };
    }

    /** @param {[number, number][]} points */
    async finish(points) {
        const { state } = this;
        try {
            if (state.painting) await this.paint(points);
            else if (state.tool === "eyedropper") await this.takeLabel(points[points.length - 1]);
            else await this.label(points);
        } catch (error) {
            toastError(error);
        }
    }

    /** Gives the current label to what these points touch, and says so when that is nothing. @param {[number, number][]} points */
    async label(points) {
        const { state } = this;
        const touched = this.touched(points);
        const left = touched.filter((piece) => !passes(state, piece)).map((piece) => state.name(piece));
        const change = await this.hooks.give({ type: "stroke", ...this.look(), shape: this.shape(points), expand: state.expand, filters: state.filtersNow });
        if (!change || change.pieces.length > 0) return;
        if (touched.length === 0) toast("The stroke met nothing.");
        else if (left.length === 0) toast("Nothing has changed: it has this label already.", "", "good");
        else toast(`Nothing was labelled: ${left.slice(0, 3).join(", ")}${left.length > 3 ? " and more" : ""} left out.`, `Only faces ${filtersOn(state)} are labelled; the filters at the left, and Alt+4 to Alt+7, change that.`);
    }

    /** The pieces under a stroke, as they are shown. @param {[number, number][]} points */
    touched(points) {
        const shape = this.shape(points);
        if (shape.rectangle) return [...this.stage.seenIn(shape.rectangle)];
        const path = /** @type {[number, number][]} */ (shape.line ?? points);
        const places = path.flatMap(([x, y], i) => {
            const [x0, y0] = path[Math.max(0, i - 1)];
            const steps = Math.max(1, Math.round(PLACES / path.length));
            return Array.from({ length: steps }, (_, k) => [x0 + ((x - x0) * (k + 1)) / steps, y0 + ((y - y0) * (k + 1)) / steps]);
        });
        return [...new Set(places.map(([x, y]) => this.stage.seenAt(x, y).piece))].filter((piece) => piece >= 0);
    }

    /** Makes the label of the piece at a pixel the current label, and goes back to the tool before. @param {[number, number]} pixel */
    async takeLabel(pixel) {
        const { state } = this;
        const { piece } = await postJson("/api/annotate/pick", { ...this.look(), pixel });
        state.set(state.afterEyedropper);
        if (piece < 0) return;
        const { semantic, instance } = state.pieces;
        const bySemantic = state.layer === "semantic";
        if (bySemantic && semantic[piece] >= 1) state.setClass(semantic[piece]);
        else if (!bySemantic && instance[piece] >= 1) state.set({ fresh: null, currentInstance: instance[piece], erase: false, unique: false });
        else toast(`${state.name(piece)} has no ${bySemantic ? "class" : "instance"} to take.`);
    }

    /** Adds the visible faces of the piece to what is to be split off; erase takes them out. @param {[number, number][]} points */
    async paint(points) {
        const { painting } = this.state;
        const { mesh } = this.stage;
        if (!painting || !mesh) return;
        const { faces } = await postJson("/api/annotate/select", { ...this.look(), shape: this.shape(points), faces: true });
        for (const face of faces) {
            if (mesh.geometry.pieceOfFace[mesh.place(face)] !== painting.piece) continue;
            if (painting.erase) painting.faces.delete(face);
            else painting.faces.add(face);
        }
        this.stage.setPaintedFaces(painting.faces);
        this.state.tell("painting");
    }

    /** Highlights what the rectangle would select, judged by the picture. */
    preview() {
        if (!this.points) return;
        const [a, b] = [this.points[0], this.points[this.points.length - 1]];
        const seen = [...this.stage.seenIn([...a, ...b])].filter((piece) => passes(this.state, piece));
        this.stage.setMarks([], seen);
    }

    /** Draws the stroke so far. */
    show() {
        const points = this.points ?? [];
        const [[x0, y0], [x1, y1]] = [points[0], points[points.length - 1]];
        const box = this.tool === "rectangle";
        const shape = document.createElementNS("http://www.w3.org/2000/svg", box ? "rect" : "polyline");
        const attributes = box
            ? { x: Math.min(x0, x1), y: Math.min(y0, y1), width: Math.abs(x1 - x0), height: Math.abs(y1 - y0) }
            : { points: points.map((point) => point.join(",")).join(" ") };
        for (const [name, value] of Object.entries(attributes)) shape.setAttribute(name, String(value));
        byId("strokes").replaceChildren(shape);
    }
}
