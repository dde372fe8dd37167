// The panels "To do" and "Progress": pieces that lack a label, shares of what is labelled, and the work log.

import { getJson } from "../shared/api.js";
import { byId, el, spaced } from "../shared/dom.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { carriedPart } from "./carried_part.js";
import { PieceList } from "./list.js";
import { classCell, selecting } from "./pieces_panel.js";
import { commandButton } from "./toolbar.js";

/** What the list "To do" may have. */
const LISTS = [["semantic", "without a class"], ["instance", "with a class, without an instance"], ["done", "done, to be approved"], ["question", "with a question"]];

/**
 * The list of what lacks a label, by pixels, or what is to be reviewed, and how far the selection is.
 *
 * @param {import("./state.js").State} state
 * @param {import("./actions.js").Actions} act
 * @param {Map<string, import("./commands.js").Command>} table
 */
export function unlabelledPanel(state, act, table) {
    /** @type {Map<number, import("./actions.js").Missing>} */
    let byPiece = new Map();
    const words = el("p", { class: "quiet words" });
    const which = el("select", { "aria-label": "What is missing" }, ...LISTS.map(([value, text]) => el("option", { value }, text)));
    const count = el("span", { class: "quiet number" });
    const list = new PieceList("To do", "Nothing is left to do here.", {
        row: (piece) => {
            const pixels = byPiece.get(piece)?.pixels ?? 0;
            const review = state.reviewOf(piece);
            return { piece, label: [state.name(piece), review || `${spaced(pixels)} pixels`].join(", "), cells: [state.name(piece), classCell(state, state.pieces.semantic[piece]), review || spaced(pixels)] };
        },
        isSelected: (piece) => state.selection.has(piece),
        select: selecting(state),
        open: (piece) => act.looking.goToPiece(piece, byPiece.get(piece)?.best_view),
    });
    const refresh = () => {
        byPiece = new Map(act.unlabelled.map((one) => [one.piece, one]));
        list.show([...byPiece.keys()].filter((piece) => piece < state.count && act.isMissing(piece)));
        count.textContent = spaced(list.pieces.length);
    };
    which.addEventListener("change", () => {
        act.lacking = which.value;
        refresh();
    });
    state.addEventListener("progress", (event) => {
        const { visible } = /** @type {CustomEvent} */ (event).detail;
        words.textContent = `Pixels over ${visible.views} ${visible.views_of ?? "views"}. Double click, or the dot key, goes there.`;
        refresh();
    });
    state.on(["labels", "reviews"], refresh);
    state.on(["selection"], () => list.draw());
    const panel = el("div", { class: "todo" }, el("div", { class: "head" }, which, count), list.element, reviewButtons(state, table), words);
    panel.addEventListener("shown", () => list.draw());
    return panel;
}

/** What is said of the selection. @param {import("./state.js").State} state @param {Map<string, import("./commands.js").Command>} table */
function reviewButtons(state, table) {
    const buttons = [["done", "Done"], ["approve", "Approve"], ["question", "Question"], ["to-do", "To do"]].map(([id, text]) => commandButton(state, table, id, text));
    const row = el("div", { class: "review", role: "group", "aria-label": "Review state of the selection" }, ...buttons);
    state.on(["selection"], () => {
        for (const button of buttons) button.disabled = state.selection.size === 0;
    });
    oneTabStop(row);
    return row;
}

/** @param {number} seconds */
const duration = (seconds) => `${Math.floor(seconds / 3600)} h ${Math.floor((seconds % 3600) / 60)} min`;
/** @param {number} share */
const percent = (share) => `${(share * 100).toFixed(1)} %`;

/** Shares, and the work log. @param {import("./state.js").State} state */
export function progressPanel(state) {
    const bars = el("div", {});
    const log = el("div", {});
    state.addEventListener("progress", (event) => {
        const { visible, area_share, labelled_pieces, pieces, by_layer, conflicts } = /** @type {CustomEvent} */ (event).detail;
        const instance = by_layer?.instance ?? {};
        const mixed = conflicts ?? [];
        bars.replaceChildren(
            ...bar("Visible pixels with a class", visible.pixels_labelled_share),
            ...bar("Area with a class", area_share),
            ...bar("Pieces with a class", labelled_pieces / Math.max(1, pieces)),
            ...bar("Area with an instance", instance.area_share ?? 0),
            ...bar("Pieces done or approved", [...state.reviews.values()].filter(({ state: one }) => one === "done" || one === "approved").length / Math.max(1, pieces)),
            ...mixed.slice(0, 8).map((/** @type {any} */ one) => el("p", {}, `Instance ${one.instance} has pieces of different classes.`)),
        );
        byId("progress-line").textContent = `${percent(visible.pixels_labelled_share)} of visible pixels, ${labelled_pieces} of ${pieces} pieces`;
    });
    const carried = el("div", {});
    const panel = el("div", {}, el("div", { class: "words" }, el("h2", {}, "Progress"), bars, el("h2", {}, "Work log"), log, carried));
    panel.addEventListener("shown", async () => {
        carried.replaceChildren(...(await carriedPart(state)));
        const { sessions, active_seconds, actions } = await getJson("/api/annotate/worklog").catch(() => ({ sessions: [], active_seconds: 0, actions: 0 }));
        const rows = sessions.slice(-12).reverse().flatMap((/** @type {any} */ one) => [el("dt", { class: "quiet" }, new Date(one.start).toLocaleString()), el("dd", { class: "number" }, duration(one.active_seconds))]);
        log.replaceChildren(el("dl", { class: "facts" }, el("dt", {}, "Time at work (idle time is not counted)"), el("dd", { class: "number" }, duration(active_seconds)), el("dt", {}, "Edits"), el("dd", { class: "number" }, spaced(actions)), ...rows));
    });
    return panel;
}

/** @param {string} title @param {number} share */
function bar(title, share) {
    const fill = el("i");
    fill.style.width = `${Math.min(1, share) * 100}%`;
    return [
        el("dl", { class: "facts" }, el("dt", {}, title), el("dd", { class: "number" }, percent(share))),
        el("div", { class: "bar", role: "progressbar", "aria-label": title, "aria-valuenow": Math.round(share * 100) }, fill),
    ];
}
