// The panel "Objects": the instances and classes in the picture; pointing at an instance marks it.

import { el, facts } from "../shared/dom.js";
import { cssColor } from "./colors.js";
import { relationsPart, wordsOf } from "./described.js";
import { brief, percent } from "./numbers.js";

/** @typedef {import("./session.js").Session} Session */

/**
 * @param {Session} session
 * @param {import("./catalogue.js").FrameFacts | null} known
 * @param {() => void} repaint
 */
export function objectsPanel(session, known, repaint) {
    const { frame, instance } = session.store.state;
    const there = session.layersOf(frame);
    if (!there.includes("semantic_instance") && !there.includes("semantic")) {
        return [el("p", { class: "quiet" }, "This frame has no labels. `enfilade label` joins them from a table, without rendering again.")];
    }
    return [...(instance ? chosenPart(session, known, instance) : []), ...instancesPart(session, known, repaint), ...classesPart(session)];
}

/** @param {Session} session @param {import("./catalogue.js").FrameFacts | null} known @param {number} id */
function chosenPart(session, known, id) {
    const { looks } = session;
    const view = known?.instances.find((one) => one.instance === id);
    const box = looks.box(id);
    const names = looks.objectsOfInstance(id);
    const words = wordsOf(session, id);
    return [
        el("h2", {}, `Instance ${id}`),
        facts([
            ["Class", looks.className(looks.classOfInstance(id))],
            ...words,
            ["Parts", names.slice(0, 6).join(", ") + (names.length > 6 ? ` and ${names.length - 6} more` : "")],
            ["Box", words.length ? null : box && `${box.extents.map((v) => v.toFixed(2)).join(" × ")} m`],
            ["Centre", box && `${box.center.map((v) => v.toFixed(2)).join(", ")} m`],
            ["Visible", view && `${view.visible_pixels} px, ${percent(view.visibility)} of it`],
            ["Cut off", view && percent(view.truncation)],
        ]),
        ...relationsPart(session, id),
    ];
}

/** @param {Session} session @param {import("./catalogue.js").FrameFacts | null} known @param {() => void} repaint */
function instancesPart(session, known, repaint) {
    const { frame } = session.store.state;
    const areas = session.areasOf(frame, "semantic_instance");
    if (!areas) return [el("h2", {}, "Instances"), el("p", { class: "quiet" }, "Reading …")];
    const ofClass = session.store.state.class;
    const isChosen = (/** @type {number} */ id) => id > 0 && (!ofClass || session.looks.classOfInstance(id) === ofClass);
    const list = [...areas].filter(([id]) => isChosen(id)).sort((a, b) => b[1].pixels - a[1].pixels);
    const row = (/** @type {[number, import("./areas.js").Area]} */ [id, area]) => {
        const visibility = known?.instances.find((one) => one.instance === id)?.visibility;
        const mark = (/** @type {boolean} */ on) => {
            session.hoveredInstance = on ? id : 0;
            repaint();
        };
        const pin = () => session.store.set({ instance: session.store.state.instance === id ? 0 : id });
        return el("tr", { tabIndex: 0, "aria-selected": String(session.store.state.instance === id), "data-instance": id, "data-key": `instance-${id}`, title: session.looks.instanceName(id),
            onpointerenter: () => mark(true), onpointerleave: () => mark(false), onfocus: () => mark(true), onblur: () => mark(false), onclick: pin,
            onkeydown: (/** @type {KeyboardEvent} */ e) => e.key === "Enter" && pin() },
            el("td", {}, el("span", { class: "swatch", style: `background:${cssColor(session.looks.color("semantic_instance", id))}` }), ` ${session.looks.instanceName(id)}`,
                el("div", { class: "quiet" }, session.looks.className(session.looks.classOfInstance(id)))),
            el("td", { class: "number" }, brief(area.pixels)),
            el("td", { class: "number" }, visibility === undefined ? "" : percent(visibility)));
    };
    return [el("h2", {}, list.length === 1 ? "1 instance" : `${list.length} instances`), table(["Name and class", "pixels", "seen"], ["auto", "4.6em", "4.2em"], list.map(row))];
}

/** @param {Session} session */
function classesPart(session) {
    const areas = session.areasOf(session.store.state.frame, "semantic");
    if (!areas) return [];
    const all = [...areas.values()].reduce((sum, area) => sum + area.pixels, 0);
    const { store } = session;
    const choose = (/** @type {number} */ id) => store.set({ class: store.state.class === id ? 0 : Math.max(0, id), instance: 0 });
    const row = (/** @type {[number, import("./areas.js").Area]} */ [id, area]) =>
        el("tr", { "data-class": id, "data-key": `class-${id}`, tabIndex: 0, "aria-selected": String(store.state.class === id), title: "Show only this class", onclick: () => choose(id),
            onkeydown: (/** @type {KeyboardEvent} */ e) => e.key === "Enter" && choose(id) }, el("td", {}, el("span", { class: "swatch", style: `background:${cssColor(session.looks.color("semantic", id))}` }), ` ${session.looks.className(id)}`),
            el("td", { class: "number" }, id > 0 ? String(id) : "–"), el("td", { class: "number" }, percent(area.pixels / all)));
    const whole = store.state.class ? el("button", { type: "button", "data-key": "all-classes", onclick: () => store.set({ class: 0 }) }, "Show all") : null;
    return [el("div", { class: "heading-row" }, el("h2", {}, "Classes"), whole), table(["Class", "id", "of image"], ["auto", "3em", "5.4em"], [...areas].sort((a, b) => b[1].pixels - a[1].pixels).map(row))];
}

/** @param {string[]} heads @param {string[]} widths @param {Node[]} rows */
function table(heads, widths, rows) {
    return el("table", { class: "rows" }, el("colgroup", {}, ...widths.map((width) => el("col", { style: `width:${width}` }))),
        el("thead", {}, el("tr", {}, ...heads.map((head, i) => el("th", { class: i ? "number" : "" }, head)))), el("tbody", {}, ...rows));
}
