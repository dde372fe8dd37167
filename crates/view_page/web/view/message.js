// What stands in the place of a picture that cannot be shown: a heading, what was found with its path, and what to do.

import { el } from "../shared/dom.js";

/**
 * @param {HTMLElement} element
 * @param {any} problem with `error` or `message`, and `help`; null for none
 */
export function showMessage(element, problem) {
    const text = problem ? (problem.error ?? problem.message ?? String(problem)) : "";
    element.hidden = !problem;
    if (element.dataset.text === text) return;
    element.dataset.text = text;
    // Messages about files begin with their path.
    const [, path, rest] = text.match(/^((?:\/|[A-Za-z]:\\|\.{0,2}\/)\S+?): (.+)$/s) ?? [];
    element.replaceChildren(
        el("h2", {}, path ? "A file cannot be read" : text),
        ...(path ? [el("code", {}, path), el("p", {}, rest)] : []),
        ...(problem?.help ? [el("p", { class: "quiet" }, problem.help)] : []),
    );
}
