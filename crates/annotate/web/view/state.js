// The state of the viewer. All of it is in the address, so that a link shows somebody else the same.

/** @typedef {"one" | "side" | "wipe" | "space"} Mode */
/**
 * @typedef {object} State
 * @property {string} scene
 * @property {string} camera
 * @property {number} frame
 * @property {string} layer of the (left) picture
 * @property {string} other layer of the right picture
 * @property {number | null} otherFrame frame of the right picture; null: the same
 * @property {Mode} mode
 * @property {number} wipe share of the width that the left picture has
 * @property {number} zoom CSS pixels per pixel; 0: as large as fits
 * @property {number} x where the middle of the pane lies in the picture, share of its width
 * @property {number} y and of its height
 * @property {"hypersim" | "filmic" | "linear"} tone
 * @property {"frame" | "trajectory" | "fixed"} expose what exposure goes by
 * @property {number} stops of exposure on top
 * @property {Record<string, [number, number]>} ranges of layers, where the user chose
 * @property {Record<string, string>} maps of layers, where the user chose
 * @property {boolean} boxes of instances are always drawn
 * @property {number} instance that stays marked; 0: none
 * @property {string} tab of the panel on the right
 */

/** @type {State} */
const BEGINNING = {
    scene: "", camera: "", frame: -1, layer: "color", other: "depth_meters", otherFrame: null, mode: "one", wipe: 0.5, zoom: 0, x: 0.5, y: 0.5,
    tone: "hypersim", expose: "frame", stops: 0, ranges: {}, maps: {}, boxes: false, instance: 0, tab: "display",
};

/** @type {Record<string, readonly string[]>} */
const CHOICES = {
    mode: ["one", "side", "wipe", "space"],
    tone: ["hypersim", "filmic", "linear"],
    expose: ["frame", "trajectory", "fixed"],
    tab: ["display", "objects", "frame", "views"],
};

export class Store {
    constructor() {
        /** @type {State} */
        this.state = { ...BEGINNING };
        /** @type {((state: State, changed: Set<keyof State>) => void)[]} */
        this.listeners = [];
        this.writing = 0;
        this.#read();
        addEventListener("hashchange", () => {
            if (location.hash.slice(1) !== this.written) this.#read();
        });
    }

    /** @param {(state: State, changed: Set<keyof State>) => void} listener */
    listen(listener) {
        this.listeners.push(listener);
    }

    /** @param {Partial<State>} change */
    set(change) {
        const changed = /** @type {Set<keyof State>} */ (new Set());
        for (const key of /** @type {(keyof State)[]} */ (Object.keys(change))) {
            if (this.state[key] !== change[key]) changed.add(key);
        }
        if (!changed.size) return;
        this.state = { ...this.state, ...change };
        for (const listener of this.listeners) listener(this.state, changed);
        // Browsers limit changes of the address per second, so only the last of several is written.
        clearTimeout(this.writing);
        this.writing = setTimeout(() => this.write(), 150);
    }

    /** The address of what is shown now. */
    write() {
        this.written = this.hash();
        history.replaceState(null, "", `#${this.written}`);
        return location.href;
    }

    hash() {
        const { state } = this;
        const words = new URLSearchParams();
        for (const key of /** @type {(keyof State)[]} */ (Object.keys(BEGINNING))) {
            const value = state[key];
            if (value === BEGINNING[key] && !["scene", "camera", "frame", "layer"].includes(key)) continue;
            if (value === null) continue;
            if (key === "ranges") {
                for (const [layer, [low, high]] of Object.entries(state.ranges)) words.append("range", `${layer}:${low}:${high}`);
            } else if (key === "maps") {
                for (const [layer, map] of Object.entries(state.maps)) words.append("map", `${layer}:${map}`);
            } else {
                words.set(key, typeof value === "number" ? String(Number(value.toFixed(5))) : String(value));
            }
        }
        return words.toString();
    }

    /** Reads the state from the address; what is missing or invalid there gets its default. */
    #read() {
        const words = new URLSearchParams(location.hash.slice(1));
        /** @type {any} */
        const next = { ...BEGINNING, ranges: {}, maps: {} };
        for (const [key, text] of words) {
            if (key === "range") {
                const [layer, low, high] = text.split(":");
                if (Number(low) < Number(high)) next.ranges[layer] = [Number(low), Number(high)];
            } else if (key === "map") {
                const [layer, map] = text.split(":");
                next.maps[layer] = map;
            } else if (key in CHOICES) {
                if (CHOICES[key].includes(text)) next[key] = text;
            } else if (key === "otherFrame" || typeof next[key] === "number") {
                if (text !== "" && Number.isFinite(Number(text))) next[key] = Number(text);
            } else if (typeof next[key] === "boolean") {
                next[key] = text === "true";
            } else if (typeof next[key] === "string") {
                next[key] = text;
            }
        }
        next.wipe = Math.min(1, Math.max(0, next.wipe));
        next.zoom = Math.min(128, Math.max(0, next.zoom));
        next.stops = Math.min(20, Math.max(-20, next.stops));
        this.set(next);
    }
}
