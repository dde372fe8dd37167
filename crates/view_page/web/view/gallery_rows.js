// The gallery's rows: every frame of the dataset with what is known of it, in the order and within the limits that are asked for.

import { getClassShares, getGallery } from "./catalogue.js";
import { brief, percent } from "./numbers.js";

/** @typedef {import("./catalogue.js").GalleryFrame & { scene: string }} Row */
/** @typedef {import("./state.js").State} State */
/** @typedef {{ name: string, says: string, unit: string, factor: number, value: (row: Row) => number | null, show: (value: number) => string }} Column `factor`: of a value to the number in its unit */

/** A share of 1, which people read in percent. @param {string} name @param {string} says @param {(row: Row) => number | null} value @returns {Column} */
const share = (name, says, value) => ({ name, says, unit: "%", factor: 100, value, show: percent });

/** What frames can be sorted and chosen by. @type {Column[]} */
export const COLUMNS = [
    share("noise", "Noise", (row) => row.noise),
    share("clipped", "Clipped pixels", (row) => row.clipped),
    share("black", "Black pixels", (row) => row.black),
    { name: "exposure", says: "Exposure", unit: "factor", factor: 1, value: (row) => row.exposure, show: (value) => `× ${brief(value)}` },
    { name: "depth_range", says: "Depth range", unit: "m", factor: 1, value: (row) => row.depth_range, show: (value) => `${brief(value)} m` },
    share("coverage", "Labelled pixels", (row) => row.coverage),
    { name: "objects", says: "Objects", unit: "", factor: 1, value: (row) => row.objects, show: (value) => String(Math.round(value)) },
    { name: "faults", says: "Gates not passed", unit: "", factor: 1, value: (row) => row.faults.length, show: (value) => String(Math.round(value)) },
];

/** A gate rejected the frame. @param {Row} row */
export const isRejected = (row) => row.faults.some((fault) => fault.rejects);

/** Its column is there while a class is chosen. */
export const OF_CLASS = "class_share";

export class Rows {
    /** @param {() => void} changed @param {(row: Row) => import("./marks.js").Mark | null} markOf */
    constructor(changed, markOf) {
        this.changed = changed;
        this.markOf = markOf;
        /** Shares of the classes that each frame shows, by scene, camera and frame; asked for when somebody chooses by class. @type {Map<string, Record<string, number>>} */
        this.shares = new Map();
        /** Classes that frames show, by number. @type {Map<number, import("./catalogue.js").SemanticClass>} */
        this.classes = new Map();
        /** Scenes whose shares were asked for. @type {Set<string>} */
        this.counted = new Set();
        /** @type {Map<string, Row[]>} rows by scene */
        this.byScene = new Map();
        /** @type {{ error: string, help: string }[]} */
        this.problems = [];
        /** Scenes that are still to be read, and to be counted. */
        this.reading = 0;
        this.counting = 0;
        this.run = 0;
    }

    /** Scenes that something is still to be read of. */
    get left() {
        return this.reading + this.counting;
    }

    /** Reads the rows of scenes that are not here yet, a few at a time. @param {string[]} scenes @param {{ anew?: boolean }} [options] */
    async read(scenes, { anew = false } = {}) {
        const run = ++this.run;
        const missing = scenes.filter((scene) => anew || !this.byScene.has(scene));
        this.problems = [];
        this.reading = missing.length;
        const next = async () => {
            for (let scene = missing.shift(); scene !== undefined && run === this.run; scene = missing.shift()) {
                await this.#scene(scene);
                if (run !== this.run) return;
                this.reading--;
                this.changed();
            }
        };
        await Promise.all([next(), next(), next()]);
    }

    /** @param {string} scene */
    async #scene(scene) {
        try {
            const { frames, problems } = await getGallery(scene);
            this.byScene.set(scene, frames.map((frame) => ({ ...frame, scene })));
            this.problems.push(...problems);
        } catch (problem) {
            const { message, help } = /** @type {any} */ (problem);
            this.problems.push({ error: `${scene}: ${message}`, help: help ?? "" });
        }
    }

    /** Reads which classes frames show, a scene at a time. @param {string[]} scenes */
    async count(scenes) {
        const missing = scenes.filter((scene) => !this.counted.has(scene));
        for (const scene of missing) this.counted.add(scene);
        this.counting += missing.length;
        for (const scene of missing) {
            try {
                const { classes, frames, problems } = await getClassShares(scene);
                for (const one of classes) this.classes.set(one.id, one);
                for (const { camera, frame, shares } of frames) this.shares.set(`${scene}/${camera}/${frame}`, shares);
                this.problems.push(...problems);
            } catch (problem) {
                const { message, help } = /** @type {any} */ (problem);
                this.problems.push({ error: `${scene}: ${message}`, help: help ?? "" });
            }
            this.counting--;
            this.changed();
        }
    }

    /** Forgets what was read. */
    forget() {
        for (const known of [this.byScene, this.shares, this.classes, this.counted]) known.clear();
    }

    /** The columns of a state. @param {State} state */
    columns(state) {
        if (!state.shows) return COLUMNS;
        const name = this.classes.get(state.shows)?.name ?? `class ${state.shows}`;
        const shareOf = (/** @type {Row} */ row) => {
            const shares = this.shares.get(`${row.scene}/${row.camera}/${row.frame}`);
            return shares ? (shares[state.shows] ?? 0) : null;
        };
        return [share(OF_CLASS, `Pixels of ${name}`, shareOf), ...COLUMNS];
    }

    /** @param {State} state @param {string} name */
    columnOf(state, name) {
        return this.columns(state).find((column) => column.name === name) ?? null;
    }

    /** @param {Row} row @param {State["show"]} show */
    #isShown(row, show) {
        switch (show) {
            case "every": return true;
            case "rendered": return row.version !== null;
            case "rejected": return isRejected(row);
            case "kept": return row.version !== null && this.markOf(row) !== "dropped";
            default: return this.markOf(row) === show;
        }
    }

    /** The rows that a state's choices leave, before limits of columns. @param {State} state */
    chosen(state) {
        const scenes = state.within === "all" ? [...this.byScene.keys()].sort() : [state.scene];
        const all = scenes.flatMap((scene) => this.byScene.get(scene) ?? []);
        return all.filter((row) => (state.within !== "camera" || row.camera === state.camera)
            && this.#isShown(row, state.show)
            && (!state.gate || row.faults.some((fault) => fault.gate === state.gate)) && (!state.law || row.laws.includes(state.law))
            && (!state.shows || (this.columns(state)[0].value(row) ?? 0) > 0));
    }

    /** The rows within the limits of a state, in its order; rows without the number that is sorted by come last. @param {State} state */
    shown(state) {
        const limits = Object.entries(state.limits).flatMap(([name, limit]) => (this.columnOf(state, name) ? [{ column: /** @type {Column} */ (this.columnOf(state, name)), limit }] : []));
        const within = (/** @type {Row} */ row) => limits.every(({ column, limit: [low, high] }) => {
            const value = column.value(row);
            return value !== null && (low === null || value >= low) && (high === null || value <= high);
        });
        const rows = this.chosen(state).filter(within);
        const by = this.columnOf(state, state.sort);
        const sign = state.down ? -1 : 1;
        if (!by) return state.down ? rows.reverse() : rows;
        return rows.sort((a, b) => {
            const [x, y] = [by.value(a), by.value(b)];
            return x === null || y === null ? Number(x === null) - Number(y === null) : sign * (x - y);
        });
    }

    /** The gates and laws that some frame does not pass. */
    faults() {
        const all = [...this.byScene.values()].flat();
        const sorted = (/** @type {string[]} */ names) => [...new Set(names)].sort();
        return { gates: sorted(all.flatMap((row) => row.faults.map((fault) => fault.gate))), laws: sorted(all.flatMap((row) => row.laws)) };
    }
}
