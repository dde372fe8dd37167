// The state of the annotation page: the scene, its pieces and their labels, the selection, the tools. An event "change" says what changed.

import { CONTRARY } from "./filters.js";

/**
 * @typedef {{ id: number, name: string, color: [number, number, number] }} LabelClass
 * @typedef {{ semantic: number, confidence: number, alternatives: [number, number][], reason?: string }} Suggestion
 * @typedef {"semantic" | "instance"} Layer
 * @typedef {{ layer: Layer, value?: number, unique?: boolean, new?: boolean }} Apply
 * @typedef {"pen" | "line" | "rectangle" | "eyedropper"} Tool
 * @typedef {"piece" | "instance" | "class"} Expand
 * @typedef {import("./filters.js").Filter} Filter
 * @typedef {"to_do" | "done" | "approved" | "question"} ReviewState
 */

/** Where rejected suggestions are kept, with the scene's source. */
const REJECTED = "enfilade.annotate.rejected:";
const GOES_ON = "enfilade.annotate.goes_on";
/** So many classes count as recent. */
const RECENT = 6;

/** Asks the server for the next instance number: if pages chose numbers, two pages might choose the same. @returns {Apply} */
export const newInstance = () => ({ layer: "instance", new: true });

/** The state of the page. Everything that changes it goes through a method, which tells the listeners. */
export class State extends EventTarget {
    /** @param {any} scene reply of /api/annotate/scene @param {any} pieces reply of /api/annotate/pieces @param {Uint8Array} instanceColors */
    constructor(scene, pieces, instanceColors) {
        super();
        this.scene = scene;
        /** @type {LabelClass[]} */
        this.classes = scene.classes;
        this.classById = new Map(this.classes.map((one) => [one.id, one]));
        this.standing = scene;
        /** Columns of /api/annotate/pieces: one value per piece. */
        this.pieces = pieces;
        this.revision = pieces.revision;
        /** Three values per instance number. @type {Uint8Array} */
        this.instanceColors = instanceColors;
        /** Numbers that no piece has any more, after an undone split. @type {Set<number>} */
        this.removed = new Set();
        /** @type {Set<number>} */
        this.selection = new Set();
        /** @type {Set<number>} */
        this.hidden = new Set();
        /** @type {Set<number>} */
        this.xray = new Set();
        /** @type {Layer} */
        this.layer = "instance";
        /** @type {Tool} */
        this.tool = "rectangle";
        this.erase = false;
        this.unique = false;
        /** True when a plain drag draws with the tool. */
        this.drawMode = false;
        /** True when the next piece that is to be done follows on each label. */
        this.goesOn = localStorage.getItem(GOES_ON) === "true";
        /** What the eyedropper gives way to after its use. @type {{ tool: Tool, drawMode: boolean }} */
        this.afterEyedropper = { tool: "rectangle", drawMode: false };
        /** @type {Expand} */
        this.expand = "piece";
        /** @type {Record<Filter, boolean>} */
        this.filters = { only_without_instance: false, only_with_instance: false, only_without_class: false, only_with_class: false };
        /** True until somebody sets a filter: what has a label in the layer is protected, and erasing is for what has one. */
        this.filtersFollow = true;
        /** The class to give; null before one is chosen, and after a number that is no class. @type {number | null} */
        this.currentClass = null;
        /** Classes that were given last, the last one first. @type {number[]} */
        this.recent = [];
        /** The number that is no class. @type {number | null} */
        this.refused = null;
        /** Asks for a new instance until its number is known. Edits that get the same number share this object. @type {Apply | null} */
        this.fresh = newInstance();
        /** The instance to give, where it is not a new one. */
        this.currentInstance = 1;
        /** Painted faces to split off; with `erase` a drag takes faces out. @type {{ piece: number, faces: Set<number>, erase: boolean } | null} */
        this.painting = null;
        this.isolated = false;
        /** How far pieces are that something was said of, and by whom. @type {Map<number, { state: ReviewState, note: string, who: string }>} */
        this.reviews = new Map();
        /** Pieces that show what is suggested for them. @type {Set<number>} */
        this.proposed = new Set();
        /** Pieces whose suggestion was rejected in this browser. @type {Set<number>} */
        this.rejected = new Set(JSON.parse(localStorage.getItem(REJECTED + scene.source) ?? "[]"));
    }

    get count() {
        return this.pieces.names.length;
    }

    /** @param {number} piece */
    name(piece) {
        return this.pieces.names[piece] || `piece ${piece}`;
    }

    /** The colour of an instance, as the files have it. @param {number} instance from 1 */
    instanceColor(instance) {
        return this.instanceColors.subarray(3 * instance, 3 * instance + 3);
    }

    /** @param {number} piece */
    className(piece) {
        return this.classById.get(this.pieces.semantic[piece])?.name ?? "";
    }

    /** What is suggested for a piece and was not rejected. @param {number} piece @returns {Suggestion | null} */
    suggestion(piece) {
        return this.rejected.has(piece) ? null : (this.pieces.suggestions[piece] ?? null);
    }

    /** Rejects what is suggested for these pieces. @param {Iterable<number>} pieces */
    reject(pieces) {
        for (const piece of pieces) this.rejected.add(piece);
        localStorage.setItem(REJECTED + this.scene.source, JSON.stringify([...this.rejected]));
        this.tell("labels");
    }

    /** How far the pieces are, in words; empty where nothing was said. @param {number} piece */
    reviewOf(piece) {
        const review = this.reviews.get(piece);
        const words = review ? [review.state.replace("_", " "), review.note].filter(Boolean).join(": ") : "";
        return review?.who ? `${words} (${review.who})` : words;
    }

    /** @param {{ piece: number, state: ReviewState, note: string, who: string }[]} rows */
    takeReviews(rows) {
        this.reviews = new Map(rows.map(({ piece, state, note, who }) => [piece, { state, note, who }]));
        this.tell("reviews");
    }

    /** Tells listeners that these aspects have changed. @param {...string} aspects */
    tell(...aspects) {
        this.dispatchEvent(new CustomEvent("change", { detail: new Set(aspects) }));
    }

    /** Calls `act` now and after each change of any of these aspects. @param {string[]} aspects @param {() => void} act */
    on(aspects, act) {
        this.addEventListener("change", (event) => {
            if (aspects.some((aspect) => /** @type {CustomEvent} */ (event).detail.has(aspect))) act();
        });
        act();
    }

    /** Sets a field of the tools. @param {Record<string, any>} fields */
    set(fields) {
        Object.assign(this, fields);
        this.tell("tools", ...Object.keys(fields));
    }

    /** Makes a class the one to give, or none if no class has this number. @param {number} id */
    setClass(id) {
        const known = this.classById.has(id);
        this.set({ layer: "semantic", erase: false, currentClass: known ? id : null, refused: known ? null : id });
    }

    toggleGoingOn() {
        localStorage.setItem(GOES_ON, String(!this.goesOn));
        this.set({ goesOn: !this.goesOn });
    }

    /** A class was given. @param {number} id */
    remember(id) {
        this.recent = [id, ...this.recent.filter((one) => one !== id)].slice(0, RECENT);
        this.tell("recent");
    }

    /** Switches a filter on or off. Switching it on switches its contrary off. @param {Filter} filter @param {boolean} on */
    setFilter(filter, on) {
        this.filters = { ...this.filtersNow, [filter]: on };
        this.filtersFollow = false;
        if (on) this.filters[CONTRARY[filter]] = false;
        this.tell("tools", "filters");
    }

    /** The filters that strokes go by. @returns {Record<Filter, boolean>} */
    get filtersNow() {
        if (!this.filtersFollow) return this.filters;
        const of = this.layer === "semantic" ? "class" : "instance";
        const none = { only_without_instance: false, only_with_instance: false, only_without_class: false, only_with_class: false };
        return { ...none, [`only_${this.erase ? "with" : "without"}_${of}`]: true };
    }

    /** What somebody can undo and redo. @param {string} who @returns {{ undo: string | null, redo: string | null }} */
    own(who) {
        return this.standing.people[who] ?? this.standing.people[""];
    }

    /** @param {Iterable<number>} pieces */
    select(pieces) {
        this.selection = new Set([...pieces].filter((piece) => piece >= 0 && piece < this.count && !this.removed.has(piece)));
        this.tell("selection");
    }

    /** @param {Iterable<number>} hidden @param {Iterable<number>} xray @param {boolean} [isolated] */
    setVisibility(hidden, xray, isolated = false) {
        this.hidden = new Set(hidden);
        this.xray = new Set(xray);
        this.isolated = isolated;
        this.tell("visibility");
    }

    /** What a piece stands for: itself, or all of its instance or class. @param {number} piece @returns {number[]} */
    grown(piece) {
        const column = this.expand === "piece" ? null : this.expand === "instance" ? this.pieces.instance : this.pieces.semantic;
        if (!column || column[piece] < 1) return [piece];
        return [...Array(this.count).keys()].filter((one) => column[one] === column[piece]);
    }

    /** Pieces that rays pass through. */
    get unseen() {
        return [...new Set([...this.hidden, ...this.xray])].filter((piece) => piece < this.count && !this.removed.has(piece));
    }

    /** What a stroke or an assignment does now; null while there is no class to give. @returns {Apply | null} */
    get apply() {
        if (this.layer === "semantic" && this.erase) return { layer: "semantic", value: -1 };
        if (this.layer === "semantic") return this.currentClass === null ? null : { layer: "semantic", value: this.currentClass };
        if (this.erase) return { layer: "instance", value: -1 };
        if (this.unique) return { layer: "instance", unique: true };
        return this.fresh ?? { layer: "instance", value: this.currentInstance };
    }

    /** The server has chosen the number of a new instance. @param {Apply} asked @param {number} instance */
    number(asked, instance) {
        delete asked.new;
        asked.value = instance;
        if (this.fresh === asked) this.set({ fresh: null, currentInstance: instance });
    }

    /** Applies a change of labels or pieces, of this page or another. @param {any} change */
    takeChange(change) {
        if (change.revision <= this.revision) return false;
        this.revision = change.revision;
        const { pieces: columns } = this;
        for (const one of [...(change.added ?? []), ...(change.resized ?? [])]) {
            const at = one.piece;
            if (one.name !== undefined) columns.names[at] = one.name;
            if (one.parent !== undefined) columns.parents[at] = one.parent;
            columns.materials[at] = one.material ?? columns.materials[at];
            columns.faces[at] = one.faces;
            columns.areas_m2[at] = one.area_m2;
            columns.mins[at] = one.min;
            columns.maxs[at] = one.max;
            columns.geometry_keys[at] = one.geometry_key ?? columns.geometry_keys[at];
            columns.semantic[at] = one.semantic;
            columns.instance[at] = one.instance;
            // A suggestion for a part counts for its pieces.
            columns.suggestions[at] = columns.suggestions[columns.parents[at]] ?? null;
            columns.objects[at] = columns.objects[columns.parents[at]] ?? "";
            this.removed.delete(at);
        }
        change.pieces.forEach((/** @type {number} */ piece, /** @type {number} */ i) => {
            columns.semantic[piece] = change.semantic[i];
            columns.instance[piece] = change.instance[i];
        });
        for (const piece of change.removed ?? []) this.forget(piece);
        this.standing = change;
        this.tell("labels", "history", ...(change.added?.length || change.removed?.length ? ["pieces", "selection", "visibility"] : []));
        return true;
    }

    /** Removes a piece that an undone split had made. Such pieces have the last numbers, so the columns are cut at the end. @param {number} piece */
    forget(piece) {
        this.removed.add(piece);
        this.selection.delete(piece);
        this.hidden.delete(piece);
        this.xray.delete(piece);
        while (this.count > 0 && this.removed.has(this.count - 1)) {
            this.removed.delete(this.count - 1);
            for (const column of Object.values(this.pieces)) if (Array.isArray(column)) column.pop();
        }
    }
}
