// A long list of pieces; only the visible rows exist as elements. It is one tab stop: arrows move and select, F2 goes to the piece.

import { el } from "../shared/dom.js";

/** Height of a row, in em. */
const ROW_EM = 2;
/** Lists so far: their rows have ids of their own. */
let lists = 0;
/** Rows beyond the visible ones, above and below. */
const SPARE = 8;

/** @typedef {{ piece: number, cells: (string | Node)[], label: string }} Row */

/** The list. Its hooks say what a row shows, and what selecting and opening a piece do. */
export class PieceList {
    /**
     * @param {string} label for screen readers
     * @param {string} empty what to say when there is none
     * @param {{ row: (piece: number) => Row, isSelected: (piece: number) => boolean, select: (piece: number, more: boolean) => void, open: (piece: number) => void }} hooks
     */
    constructor(label, empty, hooks) {
        this.hooks = hooks;
        /** @type {number[]} */
        this.pieces = [];
        this.active = 0;
        this.id = `list-${++lists}`;
        /** True when the active piece has left the list, so that the active row is the one that followed it. */
        this.isPast = false;
        this.table = el("div", { class: "table" });
        this.element = el("div", { class: "scroll list", role: "listbox", tabindex: "0", "aria-label": label, "aria-multiselectable": "true", "data-empty": empty }, this.table);
        this.element.addEventListener("scroll", () => this.draw());
        this.element.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => this.key(event));
        new ResizeObserver(() => this.draw()).observe(this.element);
    }

    /** Height of a row, CSS pixels. */
    get row() {
        return ROW_EM * parseFloat(getComputedStyle(this.element).fontSize);
    }

    /** @param {number[]} pieces */
    show(pieces) {
        const active = this.pieces[this.active];
        const at = pieces.indexOf(active);
        // A list that is shown again while the row that followed is still there changes nothing about that.
        if (at < 0) this.isPast = active !== undefined && pieces.length > 0;
        this.pieces = pieces;
        this.active = at < 0 ? Math.min(this.active, Math.max(0, pieces.length - 1)) : at;
        this.draw();
    }

    /** Goes to the list, and selects its first piece. */
    begin() {
        if (this.pieces.length === 0) return;
        this.element.focus();
        this.hooks.select(this.pieces[0], false);
        this.reveal(this.pieces[0]);
        this.draw();
    }

    /** Brings a piece into sight. @param {number} piece */
    reveal(piece) {
        const at = this.pieces.indexOf(piece);
        if (at < 0) return;
        this.active = at;
        this.isPast = false;
        const { row } = this;
        const { scrollTop, clientHeight } = this.element;
        if (at * row < scrollTop || (at + 1) * row > scrollTop + clientHeight) this.element.scrollTop = at * row - clientHeight / 2;
    }

    /** @param {KeyboardEvent} event */
    key(event) {
        const page = Math.max(1, Math.floor(this.element.clientHeight / this.row) - 1);
        const steps = /** @type {Record<string, number>} */ ({ ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -1e9, End: 1e9 });
        if (event.key in steps) {
            // What followed a piece that has left the list is one step below it already.
            const step = steps[event.key] - (this.isPast && steps[event.key] > 0 ? 1 : 0);
            this.active = Math.min(this.pieces.length - 1, Math.max(0, this.active + step));
            if (this.pieces.length > 0) this.hooks.select(this.pieces[this.active], event.shiftKey);
            this.reveal(this.pieces[this.active]);
            this.draw();
            event.preventDefault();
        } else if (event.key === "F2" && this.pieces.length > 0) {
            this.hooks.open(this.pieces[this.active]);
        }
    }

    draw() {
        this.element.classList.toggle("none", this.pieces.length === 0);
        const { row } = this;
        this.table.style.height = `${this.pieces.length * row}px`;
        const first = Math.max(0, Math.floor(this.element.scrollTop / row) - SPARE);
        const last = Math.min(this.pieces.length, first + Math.ceil(this.element.clientHeight / row) + 2 * SPARE);
        this.table.replaceChildren(...this.pieces.slice(first, last).map((piece, i) => this.rowOf(piece, first + i)));
        // Only rows in sight are elements.
        if (this.active >= first && this.active < last) this.element.setAttribute("aria-activedescendant", this.rowId(this.pieces[this.active]));
        else this.element.removeAttribute("aria-activedescendant");
    }

    /** @param {number} piece */
    rowId(piece) {
        return `${this.id}-${piece}`;
    }

    /** @param {number} piece @param {number} at */
    rowOf(piece, at) {
        const { cells, label } = this.hooks.row(piece);
        const row = el(
            "div",
            {
                class: at === this.active ? "piece active" : "piece",
                id: this.rowId(piece),
                role: "option",
                "aria-selected": this.hooks.isSelected(piece),
                "aria-posinset": at + 1,
                "aria-setsize": this.pieces.length,
                "data-piece": piece,
                title: label,
                onclick: (/** @type {MouseEvent} */ event) => {
                    this.active = at;
                    this.isPast = false;
                    this.hooks.select(piece, event.ctrlKey || event.metaKey || event.shiftKey);
                },
                ondblclick: () => this.hooks.open(piece),
            },
            ...cells.map((cell) => el("span", {}, cell)),
        );
        row.style.top = `${at * ROW_EM}em`;
        return row;
    }
}
