// Which pieces a stroke may label, by the labels that they have. The server decides; the page judges alike, for previews and messages.

/** @typedef {"only_without_instance" | "only_with_instance" | "only_without_class" | "only_with_class"} Filter */

/** Filters that contradict each other. @type {Record<Filter, Filter>} */
export const CONTRARY = {
    only_without_instance: "only_with_instance",
    only_with_instance: "only_without_instance",
    only_without_class: "only_with_class",
    only_with_class: "only_without_class",
};

/** How the filters are called on the page. @type {[Filter, string][]} */
export const FILTERS = [
    ["only_without_instance", "without instance"],
    ["only_with_instance", "with instance"],
    ["only_without_class", "without class"],
    ["only_with_class", "with class"],
];

/** True when the filters let a stroke label this piece. @param {import("./state.js").State} state @param {number} piece */
export function passes({ filtersNow: filters, pieces }, piece) {
    const [classed, counted] = [pieces.semantic[piece] >= 1, pieces.instance[piece] >= 1];
    return !(filters.only_without_class && classed) && !(filters.only_with_class && !classed) && !(filters.only_without_instance && counted) && !(filters.only_with_instance && !counted);
}

/** The names of the filters that are on. @param {import("./state.js").State} state */
export const filtersOn = (state) => FILTERS.filter(([filter]) => state.filtersNow[filter]).map(([, name]) => `“${name}”`).join(" and ");
