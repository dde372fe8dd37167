// Drawing over the pictures: boxes of instances, the pixel under the cursor, the border of the wipe, numbers in large pixels.

import { boxLines, projector } from "./project.js";
import { brief, pixelOf } from "./numbers.js";
import { cssColor } from "./colors.js";
import { drawRuler } from "./ruler.js";
import { drawTracks } from "./tracks.js";

/** @typedef {import("./painter.js").Rect} Rect */
/** @typedef {import("./painter.js").Placement} Placement */
/** @typedef {import("./session.js").Pixel} Pixel */
/** @typedef {import("./session.js").Side & { data: import("./numbers.js").LayerData }} Shown */
/**
 * The pictures that are drawn over, as the stage has them.
 * @typedef {object} Pictures
 * @property {import("./session.js").Session} session
 * @property {import("./state.js").Store} store
 * @property {import("./painter.js").Painter} painter
 * @property {number} ratio device pixels per CSS pixel
 * @property {Pixel | null} pixel under the cursor
 * @property {Shown[]} last what is shown on each side
 * @property {() => number[]} pictureSize height and width
 */

/** Pixels of at least this many CSS pixels have their numbers written in them. */
const ROOM_FOR_NUMBERS = 44;

export class Overlay {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas) {
        this.canvas = canvas;
        /** Where names stand already: left, top, right, bottom. @type {number[][]} */
        this.named = [];
        this.pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    }

    /**
     * @param {Pictures} stage
     * @param {Rect[]} panes
     * @param {Placement[]} places
     */
    paint(stage, panes, places) {
        const { canvas, pen } = this;
        const { width, height } = stage.painter.canvas;
        const { mode, wipe, boxes, names, tracks, ruler } = stage.store.state;
        const needed = boxes || names || tracks || ruler !== "" || stage.session.marked > 0 || stage.pixel !== null || mode === "wipe" || places[0].zoom / stage.ratio >= ROOM_FOR_NUMBERS;
        // An empty canvas would cost time too: the browser composes it over the picture in every frame.
        canvas.style.display = needed ? "" : "none";
        if (!needed) return;
        if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
        pen.setTransform(1, 0, 0, 1, 0, 0);
        pen.clearRect(0, 0, width, height);
        for (const [i, pane] of panes.entries()) {
            pen.save();
            pen.beginPath();
            const [high, wide] = stage.pictureSize().map((side) => side * places[i].zoom);
            const [left, top] = [Math.max(pane.x, places[i].x), Math.max(pane.y, places[i].y)];
            pen.rect(left, top, Math.min(pane.x + pane.width, places[i].x + wide) - left, Math.min(pane.y + pane.height, places[i].y + high) - top);
            pen.clip();
            const side = stage.last[i];
            if (side) {
                this.named = [];
                const isOfFrame = stage.session.hasPixelsOfFrame(side);
                if (isOfFrame && (boxes || names)) for (const id of stage.session.instancesOf(side.frame, side.camera)) this.#box(stage, side, id, places[i], false);
                if (isOfFrame && stage.session.marked) this.#box(stage, side, stage.session.marked, places[i], true);
                if (isOfFrame && tracks) this.#tracks(stage, side, places[i]);
                if (isOfFrame && ruler && i === 0) drawRuler(pen, stage.session, places[i], stage.ratio);
                if (places[i].zoom / stage.ratio >= ROOM_FOR_NUMBERS) this.#numbers(stage, i, pane, places[i]);
            }
            if (stage.pixel) this.#cursor(stage, places[i], i);
            pen.restore();
        }
        if (mode === "wipe") {
            const x = Math.round(wipe * width);
            pen.fillStyle = "rgb(255 255 255 / 0.9)";
            pen.fillRect(x - stage.ratio, 0, 2 * stage.ratio, height);
            pen.beginPath();
            pen.arc(x, height / 2, 9 * stage.ratio, 0, 7);
            pen.fill();
        }
    }

    /**
     * @param {Pictures} stage
     * @param {Shown} side
     * @param {number} id
     * @param {Placement} place
     * @param {boolean} strong
     */
    #box(stage, { camera, frame }, id, place, strong) {
        const { pen } = this;
        const { looks } = stage.session;
        const pose = camera.frames.find((one) => one.frame === frame)?.pose ?? null;
        const box = looks.box(id);
        const project = projector(camera.projection, pose);
        const at = (/** @type {number} */ v, /** @type {number} */ origin) => origin + v * place.zoom;
        const seen = stage.session.boundsOf(frame, id, camera);
        if (stage.store.state.names && seen) this.#name(stage, looks.instanceName(id), at(seen[0], place.x), at(seen[1], place.y));
        if (!strong && !stage.store.state.boxes) return;
        pen.lineWidth = (strong ? 2 : 1) * stage.ratio;
        pen.strokeStyle = strong ? "rgb(255 184 51)" : cssColor(looks.color("semantic_instance", id));
        if (box && project) {
            pen.beginPath();
            for (const [x0, y0, x1, y1] of boxLines(box, project)) {
                pen.moveTo(at(x0, place.x), at(y0, place.y));
                pen.lineTo(at(x1, place.x), at(y1, place.y));
            }
            pen.stroke();
        }
        if (strong && seen) {
            pen.setLineDash([5 * stage.ratio, 4 * stage.ratio]);
            pen.strokeStyle = "rgb(255 255 255 / 0.85)";
            pen.lineWidth = stage.ratio;
            pen.strokeRect(at(seen[0], place.x), at(seen[1], place.y), (seen[2] - seen[0]) * place.zoom, (seen[3] - seen[1]) * place.zoom);
            pen.setLineDash([]);
        }
    }

    /** A name at the upper left corner of what is seen of an instance. @param {Pictures} stage @param {string} name @param {number} x @param {number} y */
    #name(stage, name, x, y) {
        const { pen } = this;
        const size = 11 * stage.ratio;
        pen.font = `${size}px ui-sans-serif, system-ui, "DejaVu Sans", sans-serif`;
        pen.textAlign = "left";
        pen.textBaseline = "top";
        const place = [x, y, x + pen.measureText(name).width + 6 * stage.ratio, y + 1.35 * size];
        // Large objects come first; a name that would cover another is left out, and is told under the cursor.
        if (this.named.some((other) => place[0] < other[2] && other[0] < place[2] && place[1] < other[3] && other[1] < place[3])) return;
        this.named.push(place);
        pen.fillStyle = "rgb(0 0 0 / 0.62)";
        pen.fillRect(x, y, place[2] - x, place[3] - y);
        pen.fillStyle = "white";
        pen.fillText(name, x + 3 * stage.ratio, y + 0.18 * size);
    }

    /** @param {Pictures} stage @param {Shown} side @param {Placement} place */
    #tracks({ session, ratio }, { camera, frame, data }, { x, y, zoom }) {
        const followed = session.tracks.of(camera);
        const [height, width] = data.size.map((length) => length * zoom);
        if (followed) drawTracks(this.pen, followed, frame, { x, y, width, height }, ratio, session.store.state.track);
    }

    /** @param {Pictures} stage @param {Placement} place @param {number} pane */
    #cursor(stage, place, pane) {
        const { pen } = this;
        const pixel = /** @type {Pixel} */ (stage.pixel);
        const [x, y] = [place.x + pixel.x * place.zoom, place.y + pixel.y * place.zoom];
        pen.lineWidth = stage.ratio;
        if (place.zoom / stage.ratio >= 5) {
            pen.strokeStyle = "rgb(0 0 0 / 0.7)";
            pen.strokeRect(x - 1.5 * stage.ratio, y - 1.5 * stage.ratio, place.zoom + 3 * stage.ratio, place.zoom + 3 * stage.ratio);
            pen.strokeStyle = "white";
            pen.strokeRect(x - 0.5, y - 0.5, place.zoom + 1, place.zoom + 1);
        } else if (stage.store.state.mode === "side" && pane !== pixel.side) {
            // A cross in the other picture, at the same pixel.
            const arm = 7 * stage.ratio;
            for (const [style, thick] of /** @type {[string, number][]} */ ([["rgb(0 0 0 / 0.8)", 3], ["white", 1]])) {
                pen.strokeStyle = style;
                pen.lineWidth = thick * stage.ratio;
                pen.beginPath();
                pen.moveTo(x - arm, y);
                pen.lineTo(x + arm, y);
                pen.moveTo(x, y - arm);
                pen.lineTo(x, y + arm);
                pen.stroke();
            }
        }
    }

    /** @param {Pictures} stage @param {number} pane @param {Rect} rect @param {Placement} place */
    #numbers(stage, pane, rect, place) {
        const { pen } = this;
        const { data } = stage.last[pane];
        if (data.step !== 1) return;
        const [height, width] = data.size;
        const cells = (/** @type {number} */ origin, /** @type {number} */ from, /** @type {number} */ length, /** @type {number} */ end) =>
            [Math.max(0, Math.floor((from - origin) / place.zoom)), Math.min(end, Math.ceil((from + length - origin) / place.zoom))];
        const [left, right] = cells(place.x, rect.x, rect.width, width);
        const [top, bottom] = cells(place.y, rect.y, rect.height, height);
        const line = 11 * stage.ratio;
        pen.font = `${line}px ui-monospace, "DejaVu Sans Mono", monospace`;
        pen.textAlign = "center";
        pen.textBaseline = "middle";
        pen.lineWidth = 3 * stage.ratio;
        pen.strokeStyle = "rgb(0 0 0 / 0.6)";
        pen.fillStyle = "white";
        for (let y = top; y < bottom; y++) {
            for (let x = left; x < right; x++) {
                const values = pixelOf(data, x, y) ?? [];
                for (const [i, value] of values.entries()) {
                    const [px, py] = [place.x + (x + 0.5) * place.zoom, place.y + (y + 0.5) * place.zoom + (i - (values.length - 1) / 2) * line * 1.15];
                    pen.strokeText(brief(value), px, py);
                    pen.fillText(brief(value), px, py);
                }
            }
        }
    }
}
