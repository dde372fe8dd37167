// Layers of frames: which are wanted, which are being fetched, which are here.
//
// The page says what it wants, most urgent first. Requests for what is no longer wanted are cancelled. On a slow connection a small
// picture is fetched first, layers are compressed, and nothing is fetched ahead before what is shown is there; the speed is measured.

import { valuesOf } from "./numbers.js";

/** @typedef {import("./numbers.js").LayerData} LayerData */
/** @typedef {{ scene: string, camera: string, frame: number, layer: string }} LayerOfFrame */

const WORKERS = Math.max(2, Math.min(4, (navigator.hardwareConcurrency || 4) - 1));
const MAX_UNDER_WAY = 6;
const MAX_BYTES = 640 * 2 ** 20;
/** Every eighth pixel: a 64th of the bytes. */
const PREVIEW_STEP = 8;
/** A connection is slow below this many megabytes per second. */
const SLOW_MB_PER_S = 25;

/** @param {LayerOfFrame} place */
export const keyOf = ({ scene, camera, frame, layer }) => `${scene}/${camera}/${frame}/${layer}`;

export class Loader {
    /** @param {(key: string) => void} arrived */
    constructor(arrived) {
        this.arrived = arrived;
        /** @type {Map<string, LayerData>} */
        this.here = new Map();
        /** @type {Map<string, { error: string, help: string }>} */
        this.failed = new Map();
        /** @type {Map<number, { key: string, worker: Worker, step: number }>} */
        this.underWay = new Map();
        /** @type {{ key: string, place: LayerOfFrame }[]} */
        this.wanted = [];
        /** So many of what is wanted are shown now. */
        this.urgent = 0;
        this.bytes = 0;
        this.orders = 0;
        this.mbPerSecond = NaN;
        this.workers = Array.from({ length: WORKERS }, () => {
            const worker = new Worker(new URL("fetcher.js", import.meta.url), { type: "module" });
            worker.addEventListener("message", ({ data }) => this.#answered(data));
            return worker;
        });
    }

    get isSlow() {
        return this.mbPerSecond < SLOW_MB_PER_S;
    }

    /** The layer, or the small picture of it. @param {LayerOfFrame} place @returns {LayerData | undefined} */
    get(place) {
        const key = keyOf(place);
        const data = this.here.get(key);
        if (data) {
            // Moved to the end of the map: the first entries are the least recently used.
            this.here.delete(key);
            this.here.set(key, data);
        }
        return data;
    }

    /** Why a layer cannot be had. @param {LayerOfFrame} place */
    failure(place) {
        return this.failed.get(keyOf(place));
    }

    /** True while something that is shown is not here in full and the line is slow, or not known to be fast: nothing else may share it. */
    get isLineTaken() {
        const isMissing = this.wanted.slice(0, this.urgent).some(({ key }) => this.here.get(key)?.step !== 1 && !this.failed.has(key));
        return isMissing && !(this.mbPerSecond >= SLOW_MB_PER_S);
    }

    /** Says what is wanted, most urgent first. @param {LayerOfFrame[]} places @param {number} [urgent] how many of them are shown */
    want(places, urgent = 0) {
        this.wanted = places.map((place) => ({ key: keyOf(place), place }));
        this.urgent = urgent;
        const keys = new Set(this.wanted.slice(0, this.isLineTaken ? urgent : undefined).map(({ key }) => key));
        for (const [id, order] of this.underWay) {
            if (!keys.has(order.key)) order.worker.postMessage({ cancel: id });
        }
        this.#order();
    }

    /** Forgets everything, so that files are read again. */
    forget() {
        this.here.clear();
        this.failed.clear();
        this.bytes = 0;
    }

    #order() {
        const { isLineTaken } = this;
        for (const [rank, { key, place }] of this.wanted.entries()) {
            if (this.underWay.size >= MAX_UNDER_WAY || (rank >= this.urgent && isLineTaken)) return;
            const known = this.here.get(key);
            if (known?.step === 1 || this.failed.has(key) || [...this.underWay.values()].some((order) => order.key === key)) continue;
            const small = !known && rank < 2 && !(this.mbPerSecond >= SLOW_MB_PER_S);
            const step = small ? PREVIEW_STEP : 1;
            const id = ++this.orders;
            const worker = this.workers[id % this.workers.length];
            this.underWay.set(id, { key, worker, step });
            const names = [place.scene, place.camera, String(place.frame), place.layer].map(encodeURIComponent).join("/");
            const query = new URLSearchParams();
            if (step > 1) query.set("step", String(step));
            if (this.isSlow) query.set("compact", "1");
            const url = new URL(`../api/view/layer/${names}?${query}`, document.baseURI);
            worker.postMessage({ id, url: url.href });
        }
    }

    /** @param {any} answer */
    #answered(answer) {
        const order = this.underWay.get(answer.id);
        this.underWay.delete(answer.id);
        if (!order) return;
        if (answer.error && !answer.gone) this.failed.set(order.key, answer);
        if (answer.bytes) this.#keep(order, answer);
        if (!answer.gone) this.arrived(order.key);
        this.#order();
    }

    /**
     * @param {{ key: string, step: number }} order
     * @param {any} answer
     */
    #keep({ key, step }, answer) {
        const { dtype, bytes, summary, shape, size } = answer;
        if (this.here.get(key)?.step === 1) return;
        if (bytes.byteLength > 100_000) {
            const speed = bytes.byteLength / 1000 / Math.max(answer.milliseconds, 1);
            this.mbPerSecond = Number.isNaN(this.mbPerSecond) ? speed : 0.7 * this.mbPerSecond + 0.3 * speed;
        }
        this.bytes += bytes.byteLength - (this.here.get(key)?.values.byteLength ?? 0);
        this.here.delete(key);
        this.here.set(key, { shape, size, dtype, summary, step, values: valuesOf(dtype, bytes) });
        const needed = new Set(this.wanted.map((wanted) => wanted.key));
        for (const [old, data] of this.here) {
            if (this.bytes <= MAX_BYTES) break;
            if (needed.has(old)) continue;
            this.here.delete(old);
            this.bytes -= data.values.byteLength;
        }
    }
}
