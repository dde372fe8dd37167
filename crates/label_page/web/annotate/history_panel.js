// The panel "History": every edit, the last one first, and above it what was undone. A click goes back or forward to an edit.

import { getJson } from "../shared/api.js";
import { el } from "../shared/dom.js";
import { confirmDialog } from "./confirm_dialog.js";
import { counted } from "./edits.js";
import { LONGEST_NAME } from "./person.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { toast, toastError } from "../shared/toast.js";

/** @typedef {{ description: string, time: string, who: string | null }} HistoryRow */

/** @param {import("./state.js").State} state @param {import("./edits.js").Edits} edits */
export function historyPanel(state, edits) {
    const list = el("div", { class: "scroll history", role: "group", "aria-label": "Edits, the last one first" });
    const name = el("input", { type: "text", value: edits.who, maxlength: LONGEST_NAME, autocomplete: "name", onchange: () => edits.setName(name.value.trim() || edits.who) });
    const panel = el("div", { hidden: true }, el("label", { class: "head" }, "Your name", name), el("p", { class: "quiet words" }, "Undo takes back what you did. A click here goes back to an edit, or forward to one that was undone, whoever made it."), list);
    const ask = confirmDialog();
    /** @param {"undo" | "redo"} type @param {HistoryRow[]} rows what is undone or done again */
    const travel = async (type, rows) => {
        const { revision } = state;
        const times = rows.length;
        const others = [...new Set(rows.map(({ who }) => who).filter((who) => who && who !== edits.who))];
        const consequence = `They can be done again until the next edit, which discards them.${others.length > 0 ? ` Some are by ${others.join(", ")}.` : ""}`;
        if (type === "undo" && (times > 1 || others.length > 0) && !(await ask(`Undo ${counted(times)}?`, consequence, "Undo"))) return;
        if (state.revision !== revision) return toast("The history has changed meanwhile, so nothing was undone.", "Choose again.");
        for (let i = 0; i < times; i++) void edits.send({ type, everyone: true });
    };
    /** @param {HistoryRow} one @param {string} kind @param {() => void} go */
    const row = ({ description, time, who }, kind, go) =>
        el("button", { class: `edit ${kind}`, title: who ? `${description}, by ${who}` : description, onclick: go }, el("span", { class: "quiet number" }, new Date(time).toLocaleTimeString([], { hour12: false })), el("span", { class: "name" }, description),
            who && who !== edits.who ? el("span", { class: "quiet who" }, who) : null);
    async function refresh() {
        if (panel.hidden) return;
        try {
            const { done, undone } = await getJson("/api/annotate/history");
            const ahead = undone.map((/** @type {HistoryRow} */ one, /** @type {number} */ i) => row(one, "undone", () => void travel("redo", undone.slice(0, i + 1)))).reverse();
            const behind = done.map((/** @type {HistoryRow} */ one, /** @type {number} */ i) => row(one, i === 0 ? "now" : "", () => void travel("undo", done.slice(0, i))));
            const beginning = el("button", { class: `edit ${done.length === 0 ? "now" : ""}`, onclick: () => void travel("undo", done) }, el("span"), el("span", { class: "name" }, "The beginning"));
            list.replaceChildren(...ahead, ...behind, beginning);
        } catch (error) {
            toastError(error);
        }
    }
    panel.addEventListener("shown", () => void refresh());
    state.on(["history"], () => void refresh());
    edits.addEventListener("name", () => state.tell("history"));
    oneTabStop(list);
    return panel;
}
