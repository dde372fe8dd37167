// The state of the viewer. All of it is in the address, so that a link shows somebody else the same, and the browser's Back goes back.

/** @typedef {"gallery" | "one" | "side" | "wipe" | "difference" | "space"} Mode */
/**
 * @typedef {object} State
 * @property {string} scene
 * @property {string} camera
 * @property {number} frame
 * @property {string} layer of the (left) picture
 * @property {string} other layer of the right picture
 * @property {number | null} otherFrame frame of the right picture; null: the same
 * @property {string} otherCamera camera of the right picture; empty: the same
 * @property {Mode} mode
 * @property {boolean} flicker the two pictures of a difference are shown in turn
 * @property {number} wipe share of the width that the left picture has
 * @property {number} zoom CSS pixels per pixel; 0: as large as fits
 * @property {number} x where the middle of the pane lies in the picture, share of its width
 * @property {number} y and of its height
 * @property {"hypersim" | "filmic" | "linear"} tone
 * @property {"frame" | "trajectory" | "fixed"} expose what exposure goes by
 * @property {number} stops of exposure on top
 * @property {Record<string, [number, number]>} ranges of layers, where the user chose
 * @property {Record<string, string>} maps of layers, where the user chose
 * @property {Record<string, true>} logs layers whose colours go by the logarithm
 * @property {boolean} boxes of instances are always drawn
 * @property {boolean} names stand on the boxes
 * @property {boolean} tracks points that are followed are drawn over the picture
 * @property {number} track point that is followed alone, from 1; 0: all
 * @property {string} ruler the pixels that a distance is measured between: x,y,x,y; of one x,y where the other is to come; empty: none
 * @property {string} span the places in 3D that a distance is measured between, metres: x,y,z,x,y,z; of one x,y,z where the other is to come; empty: none
 * @property {number} class that alone is shown in colour; 0: all
 * @property {number} instance that stays marked; 0: none
 * @property {string} tab of the panel on the right
 * @property {string} view the camera of the 3D view: position, turn and angle, separated by commas; empty: the frame's
 * @property {string} sort column of the gallery; empty: order of the frames
 * @property {boolean} down the gallery begins with the largest
 * @property {"all" | "scene" | "camera"} within frames of which the gallery shows
 * @property {"rendered" | "rejected" | "every" | "tagged" | "dropped" | "kept"} show which frames the gallery shows
 * @property {string} gate that the gallery's frames do not pass
 * @property {string} law that the gallery's frames break
 * @property {number} shows class that the gallery's frames show; 0: any
 * @property {Record<string, [number | null, number | null]>} limits of the gallery's columns
 */

/** @type {State} */
const BEGINNING = {
    scene: "", camera: "", frame: -1, layer: "color", other: "depth_meters", otherFrame: null, otherCamera: "", mode: "one", flicker: false, wipe: 0.5, zoom: 0, x: 0.5, y: 0.5,
    tone: "hypersim", expose: "frame", stops: 0, ranges: {}, maps: {}, logs: {}, boxes: false, names: false, tracks: false, track: 0, ruler: "", span: "", class: 0, instance: 0, tab: "display", view: "",
    sort: "", down: false, within: "all", show: "rendered", gate: "", law: "", shows: 0, limits: {},
};

/** @type {Record<string, readonly string[]>} */
const CHOICES = {
    mode: ["gallery", "one", "side", "wipe", "difference", "space"],
    tone: ["hypersim", "filmic", "linear"],
    expose: ["frame", "trajectory", "fixed"],
    tab: ["display", "objects", "frame", "views", "pairs"],
    within: ["all", "scene", "camera"],
    show: ["rendered", "rejected", "every", "tagged", "dropped", "kept"],
};

/** Words whose change is a step that Back takes back; others change what stands there. */
const STEPS = ["scene", "camera", "frame", "layer", "other", "otherFrame", "otherCamera", "mode", "sort", "within", "show", "gate", "law", "shows"];

/** Words that stand in the address also where they are as at the beginning, if they say anything. */
const PLACE = ["scene", "camera", "frame", "layer"];

export class Store {
    constructor() {
        /** @type {State} */
        this.state = { ...BEGINNING };
        /** @type {((state: State, changed: Set<keyof State>) => void)[]} */
        this.listeners = [];
        this.writing = 0;
        /** True when the next writing of the address is a step of its own. */
        this.isStep = false;
        this.#read();
        addEventListener("popstate", () => {
            if (location.hash.slice(1) !== this.written) this.#read();
        });
    }

    /** @param {(state: State, changed: Set<keyof State>) => void} listener */
    listen(listener) {
        this.listeners.push(listener);
    }

    /**
     * @param {Partial<State>} change
     * @param {{ step?: boolean }} [options] step: false where the change is none of the user's, or one of many in a row
     */
    set(change, { step = true } = {}) {
        const changed = /** @type {Set<keyof State>} */ (new Set());
        for (const key of /** @type {(keyof State)[]} */ (Object.keys(change))) {
            if (this.state[key] !== change[key]) changed.add(key);
        }
        if (!changed.size) return;
        this.isStep ||= step && STEPS.some((key) => changed.has(/** @type {keyof State} */ (key)));
        this.state = { ...this.state, ...change };
        for (const listener of this.listeners) listener(this.state, changed);
        // Browsers limit changes of the address per second, so only the last of several is written.
        clearTimeout(this.writing);
        this.writing = setTimeout(() => this.write(), 150);
    }

    /** The address of what is shown now. */
    write() {
        const hash = this.hash();
        if (hash !== location.hash.slice(1)) {
            const name = this.isStep && this.written !== undefined ? "pushState" : "replaceState";
            history[name](null, "", `#${hash}`);
        }
        this.written = hash;
        this.isStep = false;
        return location.href;
    }

    hash() {
        const { state } = this;
        const words = new URLSearchParams();
        for (const key of /** @type {(keyof State)[]} */ (Object.keys(BEGINNING))) {
            const value = state[key];
            if (value === null || value === "" || (value === BEGINNING[key] && !(PLACE.includes(key) && value !== -1))) continue;
            if (key === "ranges") {
                for (const [layer, [low, high]] of Object.entries(state.ranges)) words.append("range", `${layer}:${low}:${high}`);
            } else if (key === "maps") {
                for (const [layer, map] of Object.entries(state.maps)) words.append("map", `${layer}:${map}`);
            } else if (key === "logs") {
                for (const layer of Object.keys(state.logs)) words.append("log", layer);
            } else if (key === "limits") {
                for (const [column, [low, high]] of Object.entries(state.limits)) words.append("limit", `${column}:${low ?? ""}:${high ?? ""}`);
            } else {
                words.set(key, typeof value === "number" ? String(Number(value.toFixed(5))) : String(value));
            }
        }
        return words.toString();
    }

    /** Reads the state from the address; what is missing or invalid there gets its default. Without any address the gallery is shown. */
    #read() {
        const hash = location.hash.slice(1);
        const words = new URLSearchParams(hash);
        /** @type {any} */
        const next = { ...BEGINNING, ranges: {}, maps: {}, logs: {}, limits: {} };
        if (!hash) next.mode = "gallery";
        for (const [key, text] of words) readWord(next, key, text);
        next.wipe = Math.min(1, Math.max(0, next.wipe));
        next.zoom = Math.min(128, Math.max(0, next.zoom));
        next.stops = Math.min(20, Math.max(-20, next.stops));
        this.written = this.written === undefined ? undefined : hash;
        this.set(next, { step: false });
    }
}

/** Takes a word of the address into a state. @param {any} next @param {string} key @param {string} text */
function readWord(next, key, text) {
    const [name, low, high] = text.split(":");
    const number = (/** @type {string | undefined} */ word) => (word !== undefined && word !== "" && Number.isFinite(Number(word)) ? Number(word) : null);
    if (key === "range") {
        if (Number(low) < Number(high)) next.ranges[name] = [Number(low), Number(high)];
    } else if (key === "map") {
        next.maps[name] = low;
    } else if (key === "log") {
        next.logs[text] = true;
    } else if (key === "limit") {
        next.limits[name] = [number(low), number(high)];
    } else if (["ranges", "maps", "logs", "limits"].includes(key)) {
        return;
    } else if (Object.hasOwn(CHOICES, key)) {
        if (CHOICES[key].includes(text)) next[key] = text;
    } else if (key === "otherFrame" || typeof next[key] === "number") {
        if (number(text) !== null) next[key] = Number(text);
    } else if (typeof next[key] === "boolean") {
        next[key] = text === "true";
    } else if (typeof next[key] === "string") {
        next[key] = text;
    }
}
