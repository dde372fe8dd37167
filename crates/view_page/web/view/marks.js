// Frames that people tag or drop while they look: kept by this browser, saved as a table, and read from one.

/** @typedef {"tagged" | "dropped"} Mark */
/** @typedef {{ scene: string, camera: string, frame: number }} Place */

const STORE = "enfilade.view.marks:";
const COLUMNS = ["scene_name", "camera_name", "frame_id", "mark"];

/** @param {Place} place */
const keyOf = ({ scene, camera, frame }) => `${scene}/${camera}/${frame}`;

export class Marks {
    /** @param {string} dataset its name @param {() => void} changed */
    constructor(dataset, changed) {
        this.store = STORE + dataset;
        this.dataset = dataset;
        this.changed = changed;
        /** @type {Map<string, Mark>} */
        this.known = new Map(JSON.parse(localStorage.getItem(this.store) ?? "[]"));
    }

    /** @param {Place} place @returns {Mark | null} */
    of(place) {
        return this.known.get(keyOf(place)) ?? null;
    }

    /** @param {Mark} mark */
    count(mark) {
        return [...this.known.values()].filter((one) => one === mark).length;
    }

    /** Marks a frame, or takes the mark away where it has this one. Returns the mark that it has then. @param {Place} place @param {Mark} mark */
    turn(place, mark) {
        const key = keyOf(place);
        if (this.known.get(key) === mark) this.known.delete(key);
        else this.known.set(key, mark);
        this.#keep();
        return this.of(place);
    }

    clear() {
        this.known.clear();
        this.#keep();
    }

    #keep() {
        localStorage.setItem(this.store, JSON.stringify([...this.known]));
        this.changed();
    }

    /** Name of the table. */
    get file() {
        return `${this.dataset.replace(/[^\w.-]+/gu, "_")}_frames.csv`;
    }

    /** The table: a row for each marked frame, sorted. */
    csv() {
        const rows = [...this.known].map(([key, mark]) => [...key.split("/"), mark]).sort(([a, b, c], [d, e, f]) => a.localeCompare(d) || b.localeCompare(e) || Number(c) - Number(f));
        return [COLUMNS, ...rows].map((row) => `${row.join(",")}\n`).join("");
    }

    /** Lines of Python that leave the dropped frames out, or with tags alone keep the tagged ones. */
    python() {
        const isByDropping = this.count("dropped") > 0 || this.count("tagged") === 0;
        const [mark, word] = isByDropping ? ["dropped", "not in"] : ["tagged", "in"];
        return [
            "import csv",
            `marked = {(row["scene_name"], row["camera_name"], int(row["frame_id"])) for row in csv.DictReader(open("${this.file}")) if row["mark"] == "${mark}"}`,
            `frames = [i for i in range(len(dataset)) if dataset.place(i) ${word} marked]  # torch.utils.data.Subset(dataset, frames)`,
        ].join("\n");
    }

    /**
     * Adds the marks of a table.
     *
     * @param {string} text
     * @returns {number} how many
     * @throws {Error} which line is wrong, and what was expected
     */
    read(text) {
        const [head, ...lines] = text.trim().split(/\r?\n/u);
        if (head !== COLUMNS.join(",")) throw new Error(`line 1: found ${head.slice(0, 60)}, expected ${COLUMNS.join(",")}`);
        const rows = lines.map((line, i) => {
            const [scene, camera, frame, mark] = line.split(",");
            if (!scene || !camera || !/^\d+$/u.test(frame ?? "") || (mark !== "tagged" && mark !== "dropped")) throw new Error(`line ${i + 2}: found ${line.slice(0, 60)}, expected a scene, a camera, a frame number, and tagged or dropped`);
            return /** @type {[string, Mark]} */ ([keyOf({ scene, camera, frame: Number(frame) }), mark]);
        });
        for (const [key, mark] of rows) this.known.set(key, mark);
        this.#keep();
        return rows.length;
    }
}
