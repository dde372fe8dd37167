// Projection from the world into the picture, for cameras whose rays are a linear function of the pixel.

/** @typedef {import("./catalogue.js").Projection} Projection */
/** @typedef {import("./catalogue.js").Pose} Pose */
/** @typedef {import("./catalogue.js").Box} Box */

/** Edges are cut at this distance in front of the camera, in the units of the projector's `ahead`. */
const NEAR = 1e-3;

/** @param {number[]} a @param {number[]} b */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {number[]} a @param {number[]} b */
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @param {number[]} a @param {number} s @param {number[]} b @param {number} t */
const blend = (a, s, b, t) => [s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]];

/**
 * A function from world points to the picture (pixels from the upper left) and depth; `null` where the camera is not linear.
 * @param {Projection | null} projection
 * @param {Pose | null} pose
 * @returns {((point: number[]) => { x: number, y: number, ahead: number }) | null}
 */
export function projector(projection, pose) {
    if (!projection?.linear || !projection.corner_rays || !pose) return null;
    // The ray through (u, v) on [0,1]² is M (u, v, 1). The rays of the corners are known up to length. Their lengths relative to the first
    // follow from M(0,0) + M(1,1) = M(1,0) + M(0,1).
    const [d0, d1, d2, d3] = projection.corner_rays;
    const whole = dot(d1, cross(d2, d3));
    const a1 = dot(d0, cross(d2, d3)) / whole;
    const a3 = dot(d1, cross(d2, d0)) / whole;
    const [mu, mv] = [blend(d1, a1, d0, -1), blend(d3, a3, d0, -1)];
    const determinant = dot(mu, cross(mv, d0));
    const rows = [cross(mv, d0), cross(d0, mu), cross(mu, mv)].map((row) => row.map((v) => v / determinant));
    const r = pose.orientation;
    return (point) => {
        const p = blend(point, 1, pose.position, -1);
        const camera = [0, 1, 2].map((axis) => r[axis] * p[0] + r[3 + axis] * p[1] + r[6 + axis] * p[2]);
        const [u, v, w] = rows.map((row) => dot(row, camera));
        return { x: (u / w) * projection.width, y: (v / w) * projection.height, ahead: w };
    };
}

/** The corners of a box in the world; corner i is at the far end of axis k where bit k of i is set. @param {Box} box */
export function boxCorners({ center, extents, orientation }) {
    return Array.from({ length: 8 }, (_, i) =>
        [0, 1, 2].map((row) => center[row] + [0, 1, 2].reduce((sum, k) => sum + orientation[3 * row + k] * extents[k] * (i & (1 << k) ? 0.5 : -0.5), 0)),
    );
}

/** Pairs of corners that an edge joins. */
export const BOX_EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [1, 2, 4].filter((bit) => !(i & bit)).map((bit) => [i, i | bit]));

/**
 * The edges of a box in the picture, cut where they go behind the camera.
 * @param {Box} box
 * @param {(point: number[]) => { x: number, y: number, ahead: number }} project
 */
export function boxLines(box, project) {
    const corners = boxCorners(box);
    return BOX_EDGES.flatMap(([from, to]) => {
        let [a, b] = [corners[from], corners[to]];
        let [pa, pb] = [project(a), project(b)];
        if (pa.ahead < NEAR && pb.ahead < NEAR) return [];
        if (pa.ahead < NEAR) [a, b, pa, pb] = [b, a, pb, pa];
        if (pb.ahead < NEAR) pb = project(blend(a, 1 - (pa.ahead - NEAR) / (pa.ahead - pb.ahead), b, (pa.ahead - NEAR) / (pa.ahead - pb.ahead)));
        return [[pa.x, pa.y, pb.x, pb.y]];
    });
}
