// The panel beside the gallery: which frames it shows, by the numbers that are known of them and by what they do not pass.

import { el } from "../shared/dom.js";
import { OF_CLASS } from "./gallery_rows.js";
import { barsOf } from "./histogram.js";
import { marksPart } from "./marks_panel.js";
import { brief } from "./numbers.js";

/** Bars of a distribution. */
const BARS = 30;

/** @param {import("./gallery.js").Gallery} gallery @param {import("./state.js").Store} store */
export function filterPanel(gallery, store) {
    const { state } = store;
    const rows = gallery.rows.chosen(state);
    const { gates, laws } = gallery.rows.faults();
    const limited = Object.keys(state.limits).length > 0 || state.gate || state.law || state.shows > 0;
    const choice = (/** @type {string} */ label, /** @type {"gate" | "law"} */ key, /** @type {string[]} */ names) =>
        el("div", { class: "field" }, el("label", { for: `of-${key}` }, label), el("select", { id: `of-${key}`, "data-key": key, onchange: (/** @type {any} */ e) => store.set({ [key]: e.target.value, ...(e.target.value ? { show: "every" } : {}) }) },
            el("option", { value: "" }, "any"), ...names.map((name) => el("option", { value: name, selected: name === state[key] }, name))));
    const fields = gallery.rows.columns(state).flatMap((column) => {
        const values = rows.map(column.value).filter((value) => value !== null);
        return values.length && new Set(values).size > 1 ? [columnField(store, column, /** @type {number[]} */ (values))] : [];
    });
    return [
        el("div", { class: "heading-row" }, el("h2", {}, "Choose frames"), el("button", { type: "button", "data-key": "everything", disabled: !limited, onclick: () => store.set({ limits: {}, gate: "", law: "", shows: 0 }) }, "Show all")),
        classChoice(gallery, store),
        ...(gates.length ? [choice("Gate", "gate", gates)] : []),
        ...(laws.length ? [choice("Check", "law", laws)] : []),
        ...fields,
        ...(fields.length ? [] : [el("p", { class: "quiet" }, gallery.rows.left ? "Reading …" : "Nothing is known of these frames to choose by. `enfilade verify` measures noise, clipping and more.")]),
        ...marksPart(gallery.marks),
    ];
}

/** The choice of a class that the frames show; those that show most of it come first. @param {import("./gallery.js").Gallery} gallery @param {import("./state.js").Store} store */
function classChoice({ rows, session }, store) {
    const { limits, shows } = store.state;
    const classes = rows.classes.size > 0 ? [...rows.classes.values()] : [...(session.scene?.classes ?? [])];
    const choose = (/** @type {any} */ event) => {
        const { [OF_CLASS]: _, ...others } = limits;
        const chosen = Number(event.target.value);
        store.set({ shows: chosen, limits: others, ...(chosen ? { sort: OF_CLASS, down: true } : { sort: "", down: false }) });
    };
    const options = classes.sort((a, b) => a.name.localeCompare(b.name)).map(({ id, name }) => el("option", { value: String(id), selected: id === shows }, name));
    return el("div", { class: "field" }, el("label", { for: "of-class" }, "Shows"), el("select", { id: "of-class", "data-key": "class", onchange: choose }, el("option", { value: "0" }, "any class"), ...options));
}

/**
 * The distribution of a column, and the limits of what is shown.
 * @param {import("./state.js").Store} store
 * @param {import("./gallery_rows.js").Column} column
 * @param {number[]} values
 */
function columnField(store, column, values) {
    const [low, high] = store.state.limits[column.name] ?? [null, null];
    const [min, max] = [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
    const refused = el("p", { class: "refused", role: "alert" });
    const set = () => {
        const [a, b] = ends.map((end) => (end.value === "" ? null : end.valueAsNumber / column.factor));
        const wrong = a !== null && b !== null && a > b;
        refused.textContent = wrong ? `The min, ${column.show(a)}, must be at most the max, ${column.show(b)}.` : "";
        for (const end of ends) end.setAttribute("aria-invalid", String(wrong));
        if (!wrong) limit(a, b);
    };
    const limit = (/** @type {number | null} */ a, /** @type {number | null} */ b) => {
        const { [column.name]: _, ...others } = store.state.limits;
        store.set({ limits: a === null && b === null ? others : { ...others, [column.name]: [a, b] } });
    };
    const input = (/** @type {string} */ label, /** @type {number | null} */ value, /** @type {number} */ bound) =>
        el("input", { type: "number", step: "any", "data-key": `${column.name} ${label}`, "aria-label": `${column.says}, ${label}`, placeholder: brief(bound * column.factor), value: value === null ? "" : String(Number((value * column.factor).toPrecision(12))), onchange: set });
    const ends = [input("min", low, min), input("max", high, max)];
    return el("fieldset", { class: "column-field" }, el("legend", {}, column.says, el("span", { class: "quiet" }, column.unit ? `, ${column.unit}` : "")), barsOf(values, [min, max], BARS, [low ?? min, high ?? max], column.show, (range) => limit(range && range[0] > min ? range[0] : null, range && range[1] < max ? range[1] : null)), el("div", { class: "pair" }, ...ends), refused);
}
