// Panels whose width the user sets: by dragging the border, or with the arrow keys while it has the focus. The browser remembers the width.

import { el } from "./dom.js";

/** So narrow a panel can become, CSS pixels, and so large a share of the window it can take. */
const LEAST_PX = 140, MOST_SHARE = 0.5;
/** Steps of the arrow keys, and with Shift, CSS pixels. */
const STEP_PX = 16, LONG_STEP_PX = 80;

/**
 * Gives a panel a border that is dragged. The page's style uses the variable `--ID-width` of the panel's id, with a width of its own where
 * it is not set.
 *
 * @param {HTMLElement} panel positioned, with an id
 * @param {"left" | "right"} edge where the border is
 */
export function resizable(panel, edge) {
    const root = document.documentElement;
    const [variable, store] = [`--${panel.id}-width`, `enfilade.width.${panel.id}`];
    const border = el("div", { class: `resizer ${edge}`, role: "separator", tabindex: "0", "aria-orientation": "vertical", "aria-controls": panel.id, "aria-label": "Width of the panel",
        title: "Drag, or use the arrow keys; a double click resets the width" });
    const width = () => panel.getBoundingClientRect().width;
    const most = () => Math.max(LEAST_PX, window.innerWidth * MOST_SHARE);
    const set = (/** @type {number} */ px) => {
        const kept = String(Math.round(Math.min(most(), Math.max(LEAST_PX, px))));
        root.style.setProperty(variable, `${kept}px`);
        localStorage.setItem(store, kept);
    };
    const reset = () => {
        root.style.removeProperty(variable);
        localStorage.removeItem(store);
    };
    const outward = edge === "right" ? 1 : -1;
    border.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
        border.setPointerCapture(event.pointerId);
        event.preventDefault();
        const [from, began] = [event.clientX, width()];
        const move = (/** @type {PointerEvent} */ { clientX }) => set(began + outward * (clientX - from));
        border.addEventListener("pointermove", move);
        border.addEventListener("lostpointercapture", () => border.removeEventListener("pointermove", move), { once: true });
    });
    border.addEventListener("dblclick", reset);
    border.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        const step = outward * (event.shiftKey ? LONG_STEP_PX : STEP_PX);
        const to = /** @type {Record<string, number>} */ ({ ArrowRight: width() + step, ArrowLeft: width() - step, Home: LEAST_PX, End: most() })[event.key];
        if (to === undefined) return;
        set(to);
        event.preventDefault();
        event.stopPropagation();
    });
    new ResizeObserver(() => {
        const now = { "aria-valuemin": LEAST_PX, "aria-valuemax": Math.round(most()), "aria-valuenow": Math.round(width()) };
        for (const [name, value] of Object.entries(now)) border.setAttribute(name, String(value));
    }).observe(panel);
    panel.append(border);
    const kept = Number(localStorage.getItem(store));
    if (kept >= LEAST_PX) root.style.setProperty(variable, `${kept}px`);
}
