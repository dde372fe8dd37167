// What became of the labels of an earlier version of the scene, in the panel "Progress": those that found no part, or only a name.

import { getJson } from "../shared/api.js";
import { el } from "../shared/dom.js";

/** @typedef {{ earlier_name: string, object_name: string, semantic: string, instance: string, carried: string }} Carried */

/** How labels are carried over that need no look. */
const SURE = "by name and shape";

/** @param {import("./state.js").State} state @returns {Promise<Node[]>} nothing where nothing was carried over */
export async function carriedPart(state) {
    /** @type {Carried[]} */
    const rows = await getJson("/api/annotate/carried").catch(() => []);
    const labels = rows.filter(({ earlier_name }) => earlier_name !== "");
    if (labels.length === 0) return [];
    const doubtful = labels.filter(({ carried }) => carried !== SURE);
    const row = (/** @type {Carried} */ { earlier_name, object_name, semantic, carried }) => [
        el("dt", {}, object_name && object_name !== earlier_name ? `${earlier_name} → ${object_name}` : earlier_name),
        el("dd", {}, `${state.classById.get(Number(semantic))?.name ?? "no class"}, ${carried}`),
    ];
    const bare = rows.length - labels.length;
    return [
        el("h2", {}, "Carried over"),
        el("p", { class: "quiet" }, `${labels.length - doubtful.length} of ${labels.length} labels of the earlier version ${SURE}. ${bare} parts got none.${doubtful.length > 0 ? " To look at:" : ""}`),
        el("dl", { class: "facts carried" }, ...doubtful.flatMap(row)),
    ];
}
