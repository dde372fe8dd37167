// Colours and names of the numbers of a layer in this scene.

import { MASKS, TRAITS, idColor, idTable, mapTable, traitsColor } from "./colors.js";
import { lookOf } from "./kinds.js";

/** @typedef {import("./catalogue.js").Dataset} Dataset */
/** @typedef {import("./catalogue.js").Scene} Scene */
/** @typedef {import("./catalogue.js").LayerSpec} LayerSpec */

export class Looks {
    /** @param {Dataset} dataset */
    constructor(dataset) {
        this.dataset = dataset;
        /** @type {Map<string, LayerSpec>} */
        this.specs = new Map(dataset.layers.map((spec) => [spec.name, spec]));
        /** @type {Map<number, import("./catalogue.js").SemanticClass>} */
        this.classes = new Map();
        /** @type {Scene | null} */
        this.scene = null;
        /** @type {Map<string, Uint8Array>} */
        this.tables = new Map();
    }

    /** @param {Scene} scene @param {(import("./catalogue.js").Camera | null)[]} [cameras] whose derived pictures are shown */
    enter(scene, cameras = []) {
        const derived = cameras.flatMap((camera) => camera?.derived ?? []);
        this.specs = new Map([...this.dataset.layers, ...derived].map((spec) => [spec.name, spec]));
        if (this.scene === scene) return;
        this.scene = scene;
        this.classes = new Map(scene.classes.map((one) => [one.id, one]));
        this.tables.clear();
    }

    /** The 256 colours of a map. @param {string} map */
    mapTable(map) {
        const table = this.tables.get(map) ?? mapTable(map);
        this.tables.set(map, table);
        return table;
    }

    /** @param {string} layer */
    spec(layer) {
        return /** @type {LayerSpec} */ (this.specs.get(layer) ?? this.specs.get("color"));
    }

    /** What people call it. @param {string} layer */
    title(layer) {
        return this.specs.get(layer)?.title ?? layer;
    }

    /** @param {string} layer */
    look(layer) {
        return lookOf(this.spec(layer));
    }

    /**
     * The colours of a layer's numbers; `null` for layers that need none.
     * @param {string} layer
     * @param {string} map
     */
    table(layer, map) {
        const { kind } = this.look(layer);
        if (kind === "scalar") return this.mapTable(map);
        if (kind !== "id" && kind !== "code") return null;
        let table = this.tables.get(layer);
        if (!table) {
            table = idTable((id) => this.color(layer, id), kind === "code" ? 256 : 32768);
            this.tables.set(layer, table);
        }
        return table;
    }

    /**
     * The colour of a number of an id or code layer.
     * @param {string} layer
     * @param {number} id
     */
    color(layer, id) {
        const { like } = this.spec(layer);
        if (like === "surface_traits") return traitsColor(id);
        if (like in MASKS) return MASKS[like].find((mask) => mask.code === id)?.color ?? [255, 0, 255];
        const { of } = this.look(layer);
        if (of === "class") return this.classes.get(id)?.color ?? [0, 0, 0];
        if (of === "instance") return id < 1 ? [0, 0, 0] : (this.scene?.instance_colors[id] ?? idColor(id));
        return idColor(id);
    }

    /**
     * What a number of an id or code layer is called; empty where it has no name.
     * @param {string} layer
     * @param {number} id
     */
    name(layer, id) {
        const { like } = this.spec(layer);
        if (like === "surface_traits") return TRAITS.filter((trait) => id & trait.bit).map((trait) => trait.name).join(", ") || "nothing special";
        if (like in MASKS) return MASKS[like].find((mask) => mask.code === id)?.name ?? "unknown code";
        switch (this.look(layer).of) {
            case "class": return this.className(id);
            case "instance": return this.instanceName(id);
            case "plane": return id < 1 ? "none" : (this.scene?.described.planes[id - 1] ?? "");
            case "material": return id < 1 ? "none" : (this.scene?.materials[id - 1] ?? "");
            default: return id < 1 ? "nothing" : (this.scene?.parts[id - 1] ?? "");
        }
    }

    /** @param {number} id */
    className(id) {
        return this.classes.get(id)?.name ?? "unlabelled";
    }

    /** The names of an instance's objects. @param {number} id @returns {string[]} */
    objectsOfInstance(id) {
        const objects = this.scene?.objects;
        return objects ? objects.names.filter((_, i) => objects.instance[i] === id) : [];
    }

    /** The names of an instance's objects, shortened. @param {number} id */
    instanceName(id) {
        if (id < 1) return "none";
        const names = this.objectsOfInstance(id);
        return names.length > 1 ? `${names[0]} + ${names.length - 1}` : (names[0] ?? "");
    }

    /** The class of an instance. @param {number} id */
    classOfInstance(id) {
        const objects = this.scene?.objects;
        const at = objects ? objects.instance.indexOf(id) : -1;
        return at >= 0 && objects ? objects.semantic[at] : -1;
    }

    /** The box of an instance, of the best kind that the scene has. @param {number} id */
    box(id) {
        const boxes = this.scene?.boxes ?? {};
        const kind = ["object_aligned_2d", "object_aligned_3d", "axis_aligned"].find((kind) => boxes[kind]?.[id]);
        return kind ? boxes[kind][id] : null;
    }
}
