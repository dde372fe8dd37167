// What a reload of the page keeps, in this tab: where the camera is, and the layer and class that are given.

const STORE = "enfilade.annotate.kept";
/** So long after the last change it is kept, milliseconds. */
const REST_MS = 300;

/** @typedef {import("./state.js").State} State */
/** @typedef {import("../shared/stage3d/stage.js").Stage3d} Stage3d */

/** Keeps what changes from now on. @param {State} state @param {Stage3d} stage */
export function keep(state, stage) {
    let timer = 0;
    const soon = () => {
        clearTimeout(timer);
        timer = setTimeout(() => {
            const { camera, controls } = stage;
            const { layer, currentClass, recent } = state;
            const pose = [...camera.position.toArray(), ...camera.quaternion.toArray(), camera.fov, ...controls.lookAt.toArray()];
            sessionStorage.setItem(STORE + state.scene.source, JSON.stringify({ layer, currentClass, recent, pose, hash: location.hash }));
        }, REST_MS);
    };
    stage.addEventListener("camera", soon);
    state.on(["tools", "recent"], soon);
}

/** Takes up what the page had before it was reloaded; true where that is the camera too. @param {State} state @param {Stage3d} stage */
export function takeUp(state, stage) {
    const kept = JSON.parse(sessionStorage.getItem(STORE + state.scene.source) ?? "null");
    if (!kept) return false;
    const known = (/** @type {number} */ id) => state.classById.has(id);
    state.set({ layer: kept.layer, currentClass: known(kept.currentClass) ? kept.currentClass : null, recent: kept.recent.filter(known) });
    state.tell("recent");
    // Another address asks for another place.
    if (kept.hash !== location.hash) return false;
    stage.camera.position.fromArray(kept.pose);
    stage.camera.quaternion.fromArray(kept.pose, 3);
    stage.camera.fov = kept.pose[7];
    stage.controls.lookAt.fromArray(kept.pose, 8);
    stage.cameraMoved();
    return true;
}
