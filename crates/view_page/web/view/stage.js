// The pictures: one, two side by side, or two with a border that is wiped across. Zoom and pan are those of both.

import { lookOfDifference } from "./difference.js";
import { exposureOf, TONES } from "./exposure.js";
import { rangeOf } from "./kinds.js";
import { Painter } from "./painter.js";
import { Overlay } from "./overlay.js";
import { trackAt } from "./tracks.js";

/** @typedef {import("./state.js").State} State */
/** @typedef {import("./numbers.js").LayerData} LayerData */
/** @typedef {import("./painter.js").Rect} Rect */
/** @typedef {import("./session.js").Side} Side */
/** @typedef {import("./session.js").Pixel} Pixel */

/** A click so near to a point that is followed picks it, CSS pixels. */
const REACH_PX = 8;

/** CSS pixels per pixel. */
const MAX_ZOOM = 128;

/** How long each of two pictures is shown while they flicker; longer where less motion is wanted. */
const TURN_MS = 450, SLOW_TURN_MS = 1500;

export class Stage {
    /**
     * @param {HTMLElement} element
     * @param {import("./state.js").Store} store
     * @param {import("./session.js").Session} session
     */
    constructor(element, store, session) {
        this.element = element;
        this.store = store;
        this.session = session;
        const [picture, above] = /** @type {NodeListOf<HTMLCanvasElement>} */ (element.querySelectorAll("canvas"));
        this.painter = new Painter(picture);
        this.overlay = new Overlay(above);
        /** @type {Pixel | null} */
        this.pixel = null;
        /** Where the cursor is over the element, CSS pixels. @type {[number, number] | null} */
        this.cursor = null;
        /** @type {(pixel: Pixel | null) => void} */
        this.hovered = () => {};
        /** @type {(sides: Side[]) => void} */
        this.painted = () => {};
        this.waiting = false;
        /** Which picture is shown while two flicker. */
        this.turn = 0;
        /** What was painted last on each side, for as long as the next is on its way. @type {(Side & { data: LayerData })[]} */
        this.last = [];
        new ResizeObserver(() => this.refresh()).observe(element);
        setInterval(() => this.#flicker(), matchMedia("(prefers-reduced-motion: reduce)").matches ? SLOW_TURN_MS : TURN_MS);
        this.#listen();
    }

    /** Paints before the next picture of the screen. */
    refresh() {
        if (this.waiting) return;
        this.waiting = true;
        requestAnimationFrame(() => {
            this.waiting = false;
            this.paint();
        });
    }

    get ratio() {
        return devicePixelRatio || 1;
    }

    /** The panes in device pixels: two pictures stand beside each other, or one above the other where that makes them larger. @returns {Rect[]} */
    panes() {
        const { width, height } = this.painter.canvas;
        if (this.store.state.mode !== "side") return [{ x: 0, y: 0, width, height }];
        const gap = Math.round(2 * this.ratio);
        const [high, wide] = this.pictureSize();
        if (Math.min(width / wide, height / 2 / high) > Math.min(width / 2 / wide, height / high)) {
            const half = Math.floor((height - gap) / 2);
            return [{ x: 0, y: 0, width, height: half }, { x: 0, y: half + gap, width, height: height - half - gap }];
        }
        const half = Math.floor((width - gap) / 2);
        return [{ x: 0, y: 0, width: half, height }, { x: half + gap, y: 0, width: width - half - gap, height }];
    }

    /** CSS pixels per pixel when the whole picture is seen. */
    fit() {
        const [pane] = this.panes();
        const [height, width] = this.pictureSize();
        return Math.min(pane.width / width, pane.height / height) / this.ratio;
    }

    /** Height and width of the picture. */
    pictureSize() {
        return this.last[0]?.data.size ?? [768, 1024];
    }

    /** Where the picture lies in a pane. @param {Rect} pane */
    placement(pane) {
        const { zoom, x, y } = this.store.state;
        const [height, width] = this.pictureSize();
        const scale = (zoom || this.fit()) * this.ratio;
        const [cx, cy] = zoom ? [x, y] : [0.5, 0.5];
        // Whole device pixels, so that pixels of the picture have sharp borders.
        return { x: Math.round(pane.x + pane.width / 2 - cx * width * scale), y: Math.round(pane.y + pane.height / 2 - cy * height * scale), zoom: scale };
    }

    paint() {
        const { canvas } = this.painter;
        const box = this.element.getBoundingClientRect();
        const [width, height] = [Math.max(1, Math.round(box.width * this.ratio)), Math.max(1, Math.round(box.height * this.ratio))];
        if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
        const { state } = this.store;
        const sides = this.session.sides();
        const size = String(this.pictureSize());
        for (const [i, side] of sides.entries()) {
            const before = this.last[i];
            // The last picture stays until the next one is here, so that nothing flickers.
            if (side.data) this.last[i] = /** @type {any} */ (side);
            else if (before && this.session.failureOf(side)) delete this.last[i];
        }
        // A picture of another size has another pixel under a cursor that rests.
        if (this.cursor && String(this.pictureSize()) !== size) this.#hover(this.cursor);
        this.painter.begin(getComputedStyle(this.element).backgroundColor);
        const panes = this.panes();
        const places = panes.map((pane) => this.placement(pane));
        const difference = state.flicker ? null : this.session.difference();
        for (const i of sides.keys()) {
            const shown = this.last[i];
            // Of a difference one picture is shown: it, or the two in turn.
            if (!shown || (state.mode === "difference" && i !== (state.flicker ? this.turn : 0))) continue;
            if (difference) {
                this.painter.draw(this.#differencePicture(difference, shown), panes[0], places[0]);
                continue;
            }
            const at = state.mode === "side" ? i : 0;
            this.painter.draw(this.#picture(shown), this.#clip(i, panes[at]), places[at]);
        }
        this.overlay.paint(this, panes, places);
        this.element.dataset.frame = String(this.last[0]?.frame ?? "");
        this.painted(sides);
    }

    /** The other picture's turn. */
    #flicker() {
        const { mode, flicker } = this.store.state;
        if (mode !== "difference" || !flicker || document.hidden) return;
        this.turn = 1 - this.turn;
        this.refresh();
    }

    /** Where the picture of a side is, device pixels. @param {number} side */
    areaOf(side) {
        return this.#clip(side, this.panes()[this.store.state.mode === "side" ? side : 0]);
    }

    /** Moves the pixel whose values are read, from the middle of the picture on. @param {number} dx @param {number} dy */
    movePixel(dx, dy) {
        const [height, width] = this.pictureSize();
        const { x, y, side } = this.pixel ?? { x: Math.floor(width / 2) - dx, y: Math.floor(height / 2) - dy, side: 0 };
        this.cursor = null;
        this.pixel = { x: Math.min(width - 1, Math.max(0, x + dx)), y: Math.min(height - 1, Math.max(0, y + dy)), side };
        this.hovered(this.pixel);
        this.refresh();
    }

    /** @param {number} side @param {Rect} pane @returns {Rect} */
    #clip(side, pane) {
        const { mode, wipe } = this.store.state;
        if (mode !== "wipe") return pane;
        const border = Math.round(pane.width * wipe);
        return side === 0 ? { ...pane, width: border } : { ...pane, x: border, width: pane.width - border };
    }

    /** @param {Side & { data: LayerData }} side @returns {import("./painter.js").Picture} */
    #picture(side) {
        const { camera, frame, layer, data } = side;
        const { state } = this.store;
        const { looks } = this.session;
        const look = looks.look(layer);
        return {
            data,
            kind: look.kind,
            table: looks.table(layer, state.maps[layer] ?? look.map),
            range: rangeOf(look, data.summary, state.ranges[layer], layer in state.logs),
            logarithm: layer in state.logs,
            exposure: exposureOf(state, camera, frame, data.summary),
            tone: TONES.indexOf(state.tone),
            ...this.#mark(side),
        };
    }

    /** @param {LayerData} data @param {Side} side @returns {import("./painter.js").Picture} */
    #differencePicture(data, side) {
        const { map, range } = lookOfDifference(data);
        return { data, kind: "scalar", table: this.session.looks.mapTable(map), range, logarithm: false, exposure: 1, tone: 0, ...this.#mark(side) };
    }

    /** What stands out in a picture: an instance, or all of a class. @param {Side} side */
    #mark(side) {
        const { session } = this;
        const ofClass = !session.marked && this.store.state.class > 0;
        return { ids: session.namesOf(side, ofClass ? "semantic" : "semantic_instance"), marked: ofClass ? this.store.state.class : session.marked, alone: !session.hoveredInstance, accent: [1, 0.72, 0.2] };
    }

    /** The canvases of what is shown, painted in this moment. */
    painting() {
        this.paint();
        return [this.painter.canvas, this.overlay.canvas];
    }

    /** The pixel at a point of the element, in CSS pixels; also for points outside of the picture. @param {number} x @param {number} y */
    pixelAt(x, y) {
        const { mode, wipe } = this.store.state;
        const panes = this.panes();
        const device = [x * this.ratio, y * this.ratio];
        const at = panes.length > 1 && device[0] >= panes[1].x && device[1] >= panes[1].y ? 1 : 0;
        const place = this.placement(panes[at]);
        const side = mode === "wipe" ? Number(device[0] >= panes[0].width * wipe) : at;
        return { x: (device[0] - place.x) / place.zoom, y: (device[1] - place.y) / place.zoom, side };
    }

    /**
     * Zooms by a factor about a point of the element.
     * @param {number} factor
     * @param {number} [x] CSS pixels
     * @param {number} [y]
     */
    zoomBy(factor, x, y) {
        const [pane] = this.panes();
        const before = this.pixelAt(x ?? pane.width / this.ratio / 2, y ?? pane.height / this.ratio / 2);
        const old = this.store.state.zoom || this.fit();
        const zoom = Math.min(MAX_ZOOM, Math.max(this.fit() / 2, old * factor));
        const [h, w] = this.pictureSize();
        const old_x = this.store.state.zoom ? this.store.state.x : 0.5, old_y = this.store.state.zoom ? this.store.state.y : 0.5;
        const share = 1 - old / zoom;
        this.store.set({ zoom, x: old_x + (before.x / w - old_x) * share, y: old_y + (before.y / h - old_y) * share });
    }

    /** Moves the picture. @param {number} dx CSS pixels @param {number} dy */
    panBy(dx, dy) {
        const { zoom, x, y } = this.store.state;
        const scale = zoom || this.fit();
        const [h, w] = this.pictureSize();
        const within = (/** @type {number} */ v) => Math.min(1, Math.max(0, v));
        this.store.set({ zoom: scale, x: within((zoom ? x : 0.5) - dx / scale / w), y: within((zoom ? y : 0.5) - dy / scale / h) });
    }

    #listen() {
        const { element } = this;
        const place = (/** @type {MouseEvent} */ event) => {
            const box = element.getBoundingClientRect();
            return { x: event.clientX - box.left, y: event.clientY - box.top };
        };
        element.addEventListener("wheel", (event) => {
            event.preventDefault();
            const { x, y } = place(event);
            this.zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0018)), x, y);
        }, { passive: false });
        /** @type {{ x: number, y: number, wiping: boolean, moved: boolean } | null} */
        let drag = null;
        element.addEventListener("pointerdown", (event) => {
            const { x, y } = place(event);
            const { mode, wipe } = this.store.state;
            const wiping = mode === "wipe" && Math.abs(x - wipe * element.clientWidth) < 12;
            drag = { x, y, wiping, moved: false };
            element.setPointerCapture(event.pointerId);
        });
        element.addEventListener("pointermove", (event) => {
            const { x, y } = place(event);
            const { mode, wipe } = this.store.state;
            element.dataset.over = mode === "wipe" && Math.abs(x - wipe * element.clientWidth) < 12 ? "border" : "";
            if (drag && (drag.moved || Math.hypot(x - drag.x, y - drag.y) > 3)) {
                drag.moved = true;
                if (drag.wiping) this.store.set({ wipe: Math.min(1, Math.max(0, x / element.clientWidth)) });
                else this.panBy(x - drag.x, y - drag.y);
                [drag.x, drag.y] = [x, y];
            }
            this.#hover([x, y]);
        });
        element.addEventListener("pointerup", () => {
            if (drag && !drag.moved && !this.#pickTrack(drag.x, drag.y)) this.session.pin(this.pixel);
            drag = null;
        });
        element.addEventListener("pointerleave", () => this.#hover(null));
        element.addEventListener("dblclick", () => this.store.set({ zoom: 0, x: 0.5, y: 0.5 }));
    }

    /** Picks the point that is followed under the cursor, or lets it go; false where there is none. @param {number} x CSS pixels @param {number} y */
    #pickTrack(x, y) {
        const { state } = this.store;
        const { x: px, y: py, side } = this.pixelAt(x, y);
        const shown = this.last[side];
        const followed = state.tracks && shown ? this.session.tracks.of(shown.camera) : null;
        if (!followed) return false;
        const [height, width] = this.pictureSize();
        const reach = (REACH_PX * this.ratio) / this.placement(this.panes()[state.mode === "side" ? side : 0]).zoom;
        const track = trackAt(followed, shown.frame, [px / width, py / height], [reach / width, reach / height]);
        if (track) this.store.set({ track: track === state.track ? 0 : track });
        return track > 0;
    }

    /** @param {[number, number] | null} cursor */
    #hover(cursor) {
        this.cursor = cursor;
        const pixel = cursor && this.pixelAt(...cursor);
        const [height, width] = this.pictureSize();
        const inside = pixel && pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < height;
        this.pixel = pixel && inside ? { x: Math.floor(pixel.x), y: Math.floor(pixel.y), side: pixel.side } : null;
        this.hovered(this.pixel);
        this.refresh();
    }
}
