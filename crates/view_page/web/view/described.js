// What is said of instances and frames: words, relations with links to the others, rooms, a caption, questions with answers.

import { el, facts } from "../shared/dom.js";

/** @typedef {import("./session.js").Session} Session */
/** @typedef {import("./catalogue.js").Relation} Relation */

/** Relations as they are said, and as they are said of the object. @type {Record<string, [string, string]>} */
const SAID = {
    on: ["on", "has on it"],
    in: ["in", "has in it"],
    hangs_from: ["hangs from", "has hanging"],
    against: ["against", "has against it"],
    under: ["under", "over"],
    beside: ["beside", "beside"],
    facing: ["facing", "faced by"],
};

/** What is said of an instance, for its list of facts. @param {Session} session @param {number} id @returns {[string, any][]} */
export function wordsOf(session, id) {
    const said = session.scene?.described.instances.find((one) => one.instance === id);
    if (!said) return [];
    return [
        ["Name", said.name],
        ["Word", said.noun],
        ["Colour", said.color],
        ["Material", said.material],
        ["Size", `${said.size_m.map((v) => v.toFixed(2)).join(" × ")} m`],
        ["Room", said.room],
    ];
}

/** How an instance stands to others, each a link. @param {Session} session @param {number} id */
export function relationsPart(session, id) {
    const all = session.scene?.described.relations ?? [];
    const own = all.filter((one) => one.subject === id).map((one) => row(session, SAID[one.kind]?.[0] ?? one.kind, one, one.object));
    const others = all.filter((one) => one.object === id).map((one) => row(session, SAID[one.kind]?.[1] ?? one.kind, one, one.subject));
    if (!own.length && !others.length) return [];
    return [el("h2", {}, "Relations"), el("dl", { class: "facts relations" }, ...[...own, ...others].flat())];
}

/** @param {Session} session @param {string} words @param {Relation} relation @param {number} other */
function row(session, words, relation, other) {
    const far = relation.distance_m >= 0.005 ? `, ${relation.distance_m.toFixed(2)} m` : "";
    // Walls, floors and ceilings are no instances.
    const name = other > 0 ? nameOf(session, other) : session.looks.className(relation.object_semantic);
    const link = other > 0 ? el("button", { type: "button", class: "plain link", "data-related": other, "data-key": `related-${relation.kind}-${other}`, onclick: () => session.store.set({ instance: other }) }, name) : name;
    return [el("dt", {}, words), el("dd", {}, link, far)];
}

/** What an instance is called: its own name, else that of its objects. @param {Session} session @param {number} id */
const nameOf = (session, id) => session.scene?.described.instances.find((one) => one.instance === id)?.name || session.looks.instanceName(id) || `instance ${id}`;

/** The rooms of the scene. @param {Session} session */
export function roomsPart(session) {
    const rooms = session.scene?.described.rooms ?? [];
    return rooms.length ? [el("h2", {}, "Rooms"), facts(rooms.map(({ name, kind }) => [name, kind]))] : [];
}

/** What is said of a frame. @param {import("./catalogue.js").FrameFacts} known */
export const captionPart = ({ words: { caption } }) => (caption ? [el("h2", {}, "Caption"), el("p", { id: "caption" }, caption)] : []);

/** What is asked about a frame, and about all frames of the camera; the right answer stands out. @param {import("./catalogue.js").FrameFacts} known */
export function questionsPart({ words: { questions } }) {
    const list = (/** @type {boolean} */ ofAll) => questions.filter((one) => one.of_all_frames === ofAll);
    const rows = (/** @type {import("./catalogue.js").Question[]} */ asked) => el("dl", { class: "questions" }, ...asked.flatMap(questionRows));
    const [own, all] = [list(false), list(true)];
    return [
        ...(own.length ? [el("h2", {}, "Questions"), rows(own)] : []),
        ...(all.length ? [el("details", {}, el("summary", {}, `${all.length} about all frames`), rows(all))] : []),
    ];
}

/** @param {import("./catalogue.js").Question} question */
function questionRows({ question, options, answer, kind }) {
    const line = (/** @type {string} */ option) => (option.startsWith(`${answer}.`) ? el("b", {}, option) : option);
    const answers = options ? options.map((option) => el("span", {}, line(option))) : [el("b", {}, answer)];
    return [el("dt", { title: kind.replaceAll("_", " ") }, question), el("dd", {}, ...answers)];
}
