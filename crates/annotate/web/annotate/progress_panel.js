// The panels "To do" and "Progress": unlabelled pieces, shares of what is labelled, and the work log.

import { getJson } from "../shared/api.js";
import { byId, el, spaced } from "../shared/dom.js";
import { PieceList } from "./list.js";
import { selecting } from "./pieces_panel.js";

/** The list of what has no class, by pixels. @param {import("./state.js").State} state @param {import("./actions.js").Actions} act */
export function unlabelledPanel(state, act) {
    const byPiece = new Map();
    const words = el("p", { class: "quiet words" });
    const list = new PieceList("Unlabelled pieces", "Every piece has a class.", {
        row: (piece) => {
            const pixels = byPiece.get(piece)?.pixels ?? 0;
            return { piece, label: `${state.name(piece)}, ${pixels} pixels`, cells: [state.name(piece), "", "", spaced(pixels)] };
        },
        isSelected: (piece) => state.selection.has(piece),
        select: selecting(state),
        open: (piece) => act.goToPiece(piece, byPiece.get(piece)?.best_view),
    });
    const refresh = () => list.show(act.unlabelled.map((one) => one.piece).filter((piece) => piece < state.count && state.pieces.semantic[piece] < 1));
    state.addEventListener("progress", (event) => {
        const { unlabelled, visible } = /** @type {CustomEvent} */ (event).detail;
        byPiece.clear();
        for (const one of unlabelled) byPiece.set(one.piece, one);
        words.textContent = `Pixels over ${visible.views} ${visible.views_of ?? "views"}. Double click, or the dot key, goes there.`;
        refresh();
    });
    state.on(["labels"], refresh);
    state.on(["selection"], () => list.draw());
    const panel = el("div", { class: "todo" }, words, list.element);
    panel.addEventListener("shown", () => list.draw());
    return panel;
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
            ...mixed.slice(0, 8).map((/** @type {any} */ one) => el("p", {}, `Instance ${one.instance} has pieces of different classes.`)),
        );
        byId("progress-line").textContent = `${percent(visible.pixels_labelled_share)} of visible pixels, ${labelled_pieces} of ${pieces} pieces`;
    });
    const panel = el("div", {}, el("div", { class: "words" }, el("h2", {}, "Progress"), bars, el("h2", {}, "Work log"), log));
    panel.addEventListener("shown", async () => {
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
