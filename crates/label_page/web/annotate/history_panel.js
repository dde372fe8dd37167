// The panel "History": every edit, the last one first, and above it what was undone. A click goes back or forward to an edit.

import { getJson } from "../shared/api.js";
import { el } from "../shared/dom.js";
import { confirmDialog } from "./confirm_dialog.js";
import { counted } from "./edits.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { toast, toastError } from "../shared/toast.js";

/** @typedef {{ description: string, time: string }} HistoryRow */

/** @param {import("./state.js").State} state @param {import("./edits.js").Edits} edits */
export function historyPanel(state, edits) {
    const list = el("div", { class: "scroll history", role: "group", "aria-label": "Edits, the last one first" });
    const panel = el("div", { hidden: true }, el("p", { class: "quiet words" }, "A click goes back to an edit, or forward to one that was undone."), list);
    const ask = confirmDialog();
    /** @param {"undo" | "redo"} type @param {number} times */
    const travel = async (type, times) => {
        const { revision } = state;
        const consequence = "They can be done again until the next edit, which discards them.";
        if (type === "undo" && times > 1 && !(await ask(`Undo ${counted(times)}?`, consequence, "Undo"))) return;
        if (state.revision !== revision) return toast("The history has changed meanwhile, so nothing was undone.", "Choose again.");
        for (let i = 0; i < times; i++) void edits.send({ type });
    };
    /** @param {HistoryRow} one @param {string} kind @param {() => void} go */
    const row = ({ description, time }, kind, go) => el("button", { class: `edit ${kind}`, title: description, onclick: go }, el("span", { class: "quiet number" }, new Date(time).toLocaleTimeString()), el("span", { class: "name" }, description));
    async function refresh() {
        if (panel.hidden) return;
        try {
            const { done, undone } = await getJson("/api/annotate/history");
            const ahead = undone.map((/** @type {HistoryRow} */ one, /** @type {number} */ i) => row(one, "undone", () => void travel("redo", i + 1))).reverse();
            const behind = done.map((/** @type {HistoryRow} */ one, /** @type {number} */ i) => row(one, i === 0 ? "now" : "", () => void travel("undo", i)));
            const beginning = el("button", { class: `edit ${done.length === 0 ? "now" : ""}`, onclick: () => void travel("undo", done.length) }, el("span"), el("span", { class: "name" }, "The beginning"));
            list.replaceChildren(...ahead, ...behind, beginning);
        } catch (error) {
            toastError(error);
        }
    }
    panel.addEventListener("shown", () => void refresh());
    state.on(["history"], () => void refresh());
    oneTabStop(list);
    return panel;
}
