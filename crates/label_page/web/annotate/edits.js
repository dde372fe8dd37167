// The queue of edits for the server. They are sent one at a time and in order. An edit leaves the queue when the server has answered it;
// while the server cannot be reached, or answers for reasons that are not the edit's, the edit waits and is sent again, also after a
// reload. Each has an id, by which the server recognises an edit that it has done already.

import { ApiError, getJson, postJson } from "../shared/api.js";
import { toast, toastError } from "../shared/toast.js";
import { hear } from "./hearing.js";
import { keepName, myName } from "./person.js";

const RETRY_MS = 1500;
const STORE = "enfilade.annotate.unsent";
/** Answers that are about the edit: sent again, it would be refused again. */
const ABOUT_THE_EDIT = new Set([400, 404, 409, 413, 415, 422]);

/** A unique id. Browsers have `randomUUID` only for https and for pages of this machine. */
const newId = () => crypto.randomUUID?.() ?? Array.from(crypto.getRandomValues(new Uint32Array(4)), (part) => part.toString(36)).join("-");

/** "1 edit", "2 edits". @param {number} count */
export const counted = (count) => `${count} ${count === 1 ? "edit" : "edits"}`;

/** Sends edits and hears of those of other tabs. Events: `state` when something about saving has changed, `change` with a change, `reviews`. */
export class Edits extends EventTarget {
    /** @param {string} scene so that unsent edits of several scenes are kept apart */
    constructor(scene) {
        super();
        this.client = newId();
        /** The name of the person, whose undo is their own. */
        this.who = myName();
        this.store = `${STORE}:${scene}`;
        /** @type {{ id: string, action: any, done: (change: any) => void }[]} */
        this.queue = [];
        /** Why the first edit of the queue waits. @type {ApiError | null} */
        this.stuck = null;
        /** True while changes of other pages are not heard. */
        this.deaf = false;
        /** True when the last edit was refused for good. */
        this.refused = false;
        this.busy = false;
        /** True when the page is loaded anew, which keeps the queue. */
        this.reloading = false;
        for (const kept of JSON.parse(sessionStorage.getItem(this.store) ?? "[]")) this.queue.push({ ...kept, done: () => {} });
        if (this.queue.length > 0) toast(`The server had not answered ${counted(this.queue.length)}, sent again now.`, "", "good");
        window.addEventListener("beforeunload", (event) => {
            if (this.queue.length > 0 && !this.reloading) event.preventDefault();
        });
    }

    /** Takes another name; what was done under the one before stays its. @param {string} name */
    setName(name) {
        this.who = keepName(name);
        this.dispatchEvent(new Event("name"));
    }

    /** True while edits cannot be sent or changes cannot be heard. */
    get offline() {
        return this.stuck !== null || this.deaf;
    }

    /** @returns {"saved" | "saving" | "offline" | "refused"} */
    get state() {
        if (this.offline) return "offline";
        if (this.queue.length > 0) return "saving";
        return this.refused ? "refused" : "saved";
    }

    /** What is wrong, what that means for the edits, and what to do; empty when nothing is wrong. */
    get trouble() {
        if (!this.offline) return "";
        const silent = !this.stuck || this.stuck.status === 0;
        const kept = this.queue.length === 0 ? "Nothing is lost" : `${counted(this.queue.length)} kept here`;
        const help = silent ? "Start `enfilade annotate` on the same port to continue." : this.stuck?.help ?? "";
        return `${silent ? "The server does not answer." : `The server refuses edits: ${this.stuck?.message}.`} ${kept}; trying again. ${help}`;
    }

    /**
     * Sends an edit. Resolves with the change, or with null if it was refused for good, which the user is told.
     *
     * @param {any} action
     * @returns {Promise<any>}
     */
    send(action) {
        return new Promise((done) => {
            this.queue.push({ id: newId(), action, done });
            this.keep();
            void this.work();
        });
    }

    keep() {
        sessionStorage.setItem(this.store, JSON.stringify(this.queue.map(({ id, action }) => ({ id, action }))));
        this.tell();
    }

    tell() {
        this.dispatchEvent(new Event("state"));
    }

    async work() {
        if (this.busy) return;
        this.busy = true;
        while (this.queue.length > 0) {
            const { done } = this.queue[0];
            const change = await this.answered(this.queue[0]);
            if (change === undefined) {
                await new Promise((resume) => setTimeout(resume, RETRY_MS));
                continue;
            }
            this.queue.shift();
            if (change) this.dispatchEvent(new CustomEvent("change", { detail: change }));
            this.keep();
            done(change);
        }
        this.busy = false;
    }

    /**
     * Sends one edit: the change, null where the edit is refused for good, undefined where it has to be sent again.
     *
     * @param {{ id: string, action: any }} edit
     */
    async answered({ id, action }) {
        try {
            const change = await postJson("/api/annotate/edit", { client: this.client, who: this.who, id, action });
            [this.stuck, this.refused] = [null, false];
            return change;
        } catch (error) {
            const forGood = !(error instanceof ApiError) || ABOUT_THE_EDIT.has(error.status);
            this.stuck = forGood ? null : error;
            this.refused ||= forGood;
            if (forGood) toastError(error);
            this.tell();
            return forGood ? null : undefined;
        }
    }

    /** @param {boolean} deaf */
    setDeaf(deaf) {
        if (this.deaf === deaf) return;
        this.deaf = deaf;
        this.tell();
    }

    /** Takes everything anew. */
    reload() {
        this.reloading = true;
        location.reload();
    }

    /**
     * Listens to changes. After a lost connection the server repeats what was missed, or asks for a reload.
     *
     * @param {() => number} revision the last one that is known
     */
    listen(revision) {
        hear(revision(), (kind, text) => {
            if (kind === "message") this.dispatchEvent(new CustomEvent("change", { detail: JSON.parse(text) }));
            if (kind === "reviews") this.dispatchEvent(new Event("reviews"));
            if (kind === "reload") this.reload();
            if (kind === "open") this.setDeaf(false);
            if (kind !== "error") return;
            this.setDeaf(true);
            setTimeout(() => void this.resume(revision), RETRY_MS);
        });
    }

    /** @param {() => number} revision */
    async resume(revision) {
        try {
            const scene = await getJson("/api/annotate/scene");
            if (scene.revision < revision()) this.reload();
        } catch {
            setTimeout(() => void this.resume(revision), RETRY_MS);
            return;
        }
        this.listen(revision);
    }
}
