// The gallery: small pictures of all frames, sorted and chosen by what is known of them. Only frames in sight have elements, so there may
// be many. The list is one tab stop; arrow keys go from frame to frame, Enter opens one.

import { byId, el } from "../shared/dom.js";
import { say } from "../shared/say.js";
import { toast } from "../shared/toast.js";
import { fileUrl, thumbnailUrl } from "./catalogue.js";
import { Rows, isRejected } from "./gallery_rows.js";
import { Marks } from "./marks.js";
import { faultText } from "./records.js";

/** @typedef {import("./gallery_rows.js").Row} Row */

/** Smallest width of a place, in em; in a narrow list, so that a few stand side by side. */
const PLACE_EM = 14.5, NARROW_PLACE_EM = 9;
/** Lists are narrow below this width, in em. */
const NARROW_EM = 40;
/** Height of a place by its width, and of the text below its picture in em. */
const SHAPE = 0.75, TEXT_EM = 2.2;

export class Gallery {
    /** @param {import("./session.js").Session} session @param {() => void} changed the panel beside must follow */
    constructor(session, changed) {
        this.session = session;
        this.store = session.store;
        this.changed = changed;
        this.marks = new Marks(session.dataset.name, () => this.show());
        this.rows = new Rows(() => this.show(), (row) => this.marks.of(row));
        /** @type {Row[]} */
        this.shown = [];
        this.at = 0;
        /** Rows were asked for, so that what cannot be read is not asked for again and again. */
        this.asked = false;
        /** By what the frames are chosen and sorted. Another order begins at its first frame. */
        this.order = "";
        this.list = byId("gallery-frames");
        this.rail = el("div", { class: "rail", role: "presentation" });
        this.list.append(this.rail);
        /** @type {Map<number, HTMLElement>} */
        this.there = new Map();
        this.list.addEventListener("scroll", () => this.#fill());
        this.list.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => this.key(event));
        new ResizeObserver(() => this.#lay()).observe(this.list);
    }

    get isShown() {
        return this.store.state.mode === "gallery";
    }

    /** Changes with what the panel beside shows. */
    get panelKey() {
        return this.isShown ? `${this.marks.csv()} ${this.rows.left} ${this.rows.classes.size} ${this.shown.length} ${[...this.rows.byScene.values()].reduce((sum, rows) => sum + rows.length, 0)}` : "";
    }

    focus() {
        this.list.focus({ preventScroll: true });
    }

    /** Reads all scenes again. */
    async reload() {
        if (!this.isShown) {
            // They are asked for when the gallery is shown next.
            this.asked = false;
            return this.rows.forget();
        }
        const counted = [...this.rows.counted];
        this.rows.counted.clear();
        await this.rows.read(this.session.dataset.scenes, { anew: true });
        await this.rows.count(counted);
    }

    /** Shows the frames that the state asks for. */
    show() {
        if (!this.isShown) return;
        const { state } = this.store;
        const { scenes } = this.session.dataset;
        if (!this.rows.reading && scenes.some((scene) => !this.rows.byScene.has(scene)) && !this.asked) {
            this.asked = true;
            this.rows.read(scenes);
        }
        if (state.shows) void this.rows.count(state.within === "all" ? scenes : [state.scene]);
        const order = JSON.stringify([state.sort, state.down, state.within, state.show, state.gate, state.law, state.shows, state.limits]);
        const isOther = this.order !== "" && this.order !== order;
        const before = isOther ? null : (this.shown[this.at] ?? state);
        this.order = order;
        this.shown = this.rows.shown(state);
        this.at = Math.max(0, this.shown.findIndex((row) => row.scene === before?.scene && row.camera === before.camera && row.frame === before.frame));
        if (isOther) this.list.scrollTop = 0;
        this.#bar();
        this.there.clear();
        this.rail.replaceChildren();
        this.#lay();
        this.changed();
    }

    /** What stands above the frames: how many there are, and by what they are sorted. */
    #bar() {
        const { state } = this.store;
        const known = this.rows.columns(state).filter((column) => [...this.rows.byScene.values()].some((rows) => rows.some((row) => column.value(row) !== null)));
        const choice = (/** @type {string} */ label, /** @type {"sort" | "within" | "show"} */ key, /** @type {[string, string][]} */ options) =>
            el("label", {}, el("span", { class: "quiet" }, label), el("select", { "data-key": key, onchange: (/** @type {any} */ e) => this.store.set({ [key]: e.target.value, ...(key === "sort" ? { down: e.target.value !== "" } : {}) }) },
                ...options.map(([value, text]) => el("option", { value, selected: state[key] === value }, text))));
        const focused = /** @type {HTMLElement} */ (document.activeElement)?.dataset?.key;
        const bar = byId("gallery-bar");
        bar.replaceChildren(
            el("strong", { role: "status" }, this.rows.left ? `${counted(this.shown.length, "frame")}, reading ${this.rows.left} more scenes …` : counted(this.shown.length, "frame")),
            choice("of", "within", [["all", "the dataset"], ["scene", `scene ${state.scene}`], ["camera", `camera ${state.camera}`]]),
            choice("show", "show", [["rendered", "rendered"], ["rejected", "rejected"], ["every", "all"], ["tagged", "tagged"], ["dropped", "dropped"], ["kept", "not dropped"]]),
            choice("sort by", "sort", [["", "order of frames"], ...known.map((column) => /** @type {[string, string]} */ ([column.name, column.says.toLowerCase()]))]),
            el("button", { type: "button", "data-key": "down", title: "Turn the order", onclick: () => this.store.set({ down: !state.down }) }, (state.sort ? ["smallest first", "largest first"] : ["first to last", "last to first"])[Number(state.down)]),
            ...this.rows.problems.slice(0, 3).map(({ error, help }) => el("div", { class: "loss", role: "note" }, el("b", {}, "A file cannot be read"), el("code", {}, error), help)),
        );
        if (focused) /** @type {HTMLElement | null} */ (bar.querySelector(`[data-key="${focused}"]`))?.focus();
    }

    /** Columns, width and height of a place, CSS pixels. */
    #measures() {
        const em = parseFloat(getComputedStyle(this.list).fontSize);
        const width = this.list.clientWidth;
        const columns = Math.max(1, Math.floor(width / ((width < NARROW_EM * em ? NARROW_PLACE_EM : PLACE_EM) * em)));
        const place = width / columns;
        return { columns, width: place, height: place * SHAPE + TEXT_EM * em };
    }

    #lay() {
        if (!this.isShown) return;
        const { columns, height } = this.#measures();
        this.rail.style.height = `${Math.ceil(this.shown.length / columns) * height}px`;
        for (const element of this.there.values()) element.remove();
        this.there.clear();
        this.#fill();
    }

    /** Makes the elements in sight, and removes the others. */
    #fill() {
        const { columns, width, height } = this.#measures();
        const { scrollTop, clientHeight } = this.list;
        const first = Math.max(0, Math.floor(scrollTop / height) - 1) * columns;
        const last = Math.min(this.shown.length, (Math.ceil((scrollTop + clientHeight) / height) + 1) * columns);
        for (const [i, element] of this.there) {
            if (i >= first && i < last) continue;
            // A picture that is no longer needed is not waited for.
            element.querySelector("img")?.removeAttribute("src");
            element.remove();
            this.there.delete(i);
        }
        for (let i = first; i < last; i++) {
            if (this.there.has(i)) continue;
            const element = this.#place(this.shown[i], i);
            element.style.cssText = `left:${(i % columns) * width}px;top:${Math.floor(i / columns) * height}px;width:${width}px;height:${height}px`;
            this.there.set(i, element);
            this.rail.append(element);
        }
        this.#select();
    }

    /** @param {Row} row @param {number} i */
    #place(row, i) {
        const by = this.rows.columnOf(this.store.state, this.store.state.sort);
        const value = by?.value(row) ?? null;
        // The number first: it is what tells neighbours apart where the caption is cut.
        const name = `${row.frame} ${row.camera}${this.session.dataset.scenes.length > 1 ? ` ${row.scene}` : ""}`;
        const why = row.faults.map(faultText).concat(row.laws.map((law) => `check fails: ${law}`));
        const url = row.version ? thumbnailUrl(row.scene, row.camera, row.frame, row.version) : row.picture ? fileUrl(row.picture) : null;
        const mark = this.marks.of(row);
        const told = by ? `${by.says} ${value === null ? "not known" : by.show(value)}` : "";
        const element = el("div", { class: `place ${isRejected(row) ? "rejected" : ""}`, role: "option", id: `place-${i}`, title: [name, mark, told, ...why].filter(Boolean).join("\n"),
            "aria-setsize": this.shown.length, "aria-posinset": i + 1, "data-frame": `${row.scene}/${row.camera}/${row.frame}` },
            url ? el("img", { src: url, alt: "", draggable: false }) : el("div", { class: "nothing quiet" }, "no picture"),
            el("div", { class: "name" }, mark ? el("b", { class: mark === "dropped" ? "bad" : "good" }, mark, " ") : null, name), el("div", { class: "told number" }, by ? (value === null ? "–" : by.show(value)) : why.length ? el("span", { class: "bad" }, isRejected(row) ? "rejected" : "see why") : ""));
        element.addEventListener("click", () => this.open(i));
        return element;
    }

    /** Tags or drops the current frame, or takes that back. @param {import("./marks.js").Mark} mark */
    mark(mark) {
        const { scene, camera, frame } = this.store.state;
        const place = this.isShown ? this.shown[this.at] : { scene, camera, frame };
        if (!place) return;
        const now = this.marks.turn(place, mark);
        const text = `${place.camera} ${place.frame}: ${now ?? "not marked"}`;
        if (this.isShown) say(text);
        else toast(`${text}.`, `${this.marks.count("tagged")} tagged, ${this.marks.count("dropped")} dropped; the list is beside all frames.`, "good");
    }

    /** Opens a frame. @param {number} i */
    open(i) {
        const row = this.shown[i];
        if (!row) return;
        this.at = i;
        if (row.version === null) return this.store.set({ mode: "one", scene: row.scene, camera: row.camera, tab: "views" });
        this.store.set({ mode: "one", scene: row.scene, camera: row.camera, frame: row.frame, zoom: 0, x: 0.5, y: 0.5, instance: 0, otherFrame: null, otherCamera: "" });
        byId("stage").focus({ preventScroll: true });
    }

    /** Takes a key. @param {KeyboardEvent} event */
    key(event) {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        const { columns, height } = this.#measures();
        const page = Math.max(1, Math.floor(this.list.clientHeight / height)) * columns;
        /** @type {Record<string, number>} */
        const steps = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -columns, ArrowDown: columns, PageUp: -page, PageDown: page, Home: -Infinity, End: Infinity };
        if (event.key === "Enter") this.open(this.at);
        else if (event.key in steps) this.#go(Math.min(this.shown.length - 1, Math.max(0, this.at + steps[event.key])));
        else return;
        event.preventDefault();
        event.stopPropagation();
    }

    /** Makes a frame the current one, and brings it into sight. @param {number} i */
    #go(i) {
        this.at = Math.max(0, i);
        const { columns, height } = this.#measures();
        const top = Math.floor(this.at / columns) * height;
        if (top < this.list.scrollTop) this.list.scrollTop = top;
        else if (top + height > this.list.scrollTop + this.list.clientHeight) this.list.scrollTop = top + height - this.list.clientHeight;
        this.#fill();
        this.focus();
    }

    #select() {
        for (const [i, element] of this.there) element.setAttribute("aria-selected", String(i === this.at));
        if (this.shown.length) this.list.setAttribute("aria-activedescendant", `place-${this.at}`);
        else this.list.removeAttribute("aria-activedescendant");
    }
}

/** @param {number} count @param {string} what */
const counted = (count, what) => `${count} ${what}${count === 1 ? "" : "s"}`;
