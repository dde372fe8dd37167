// The two GPU programs of the view. `mesh` writes piece, shade and face of each pixel. `picture` turns them into colours, so that changed
// colours or highlights need no new drawing of triangles.

/** Width of the textures that hold one value per face of a block. */
export const FACE_WIDTH = 512;
/** Width of the textures that hold one value per piece. */
export const PIECE_WIDTH = 2048;
/** Width of the texture that holds one value per face of the scene. */
export const MARK_WIDTH = 4096;

/** Bits of a piece's flags. */
export const HIDDEN = 1;
export const XRAY = 2;

/** Bits of a piece's marks. */
export const SELECTED = 1;
export const PREVIEWED = 2;

export const meshVertex = /* glsl */ `
precision highp float;
precision highp int;
precision highp usampler2D;
in vec4 position;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 boundsMin;
uniform vec3 boundsSize;
uniform usampler2D pieceOfFace;
uniform usampler2D faceNumbers;
uniform usampler2D pieceFlags;
flat out uint vPiece;
flat out uint vFace;
flat out uint vFlags;
out vec3 vView;
out vec3 vCorner;
out vec3 vWorld;

void main() {
    int face = gl_VertexID / 3;
    int corner = gl_VertexID - 3 * face;
    ivec2 at = ivec2(face % ${FACE_WIDTH}, face / ${FACE_WIDTH});
    vPiece = texelFetch(pieceOfFace, at, 0).r;
    vFace = texelFetch(faceNumbers, at, 0).r;
    vFlags = texelFetch(pieceFlags, ivec2(vPiece % ${PIECE_WIDTH}u, vPiece / ${PIECE_WIDTH}u), 0).r;
    vCorner = vec3(corner == 0, corner == 1, corner == 2);
    vec3 world = boundsMin + position.xyz * boundsSize;
    vWorld = world;
    vec4 view = modelViewMatrix * vec4(world, 1.0);
    vView = view.xyz;
    // A hidden piece lies beyond the far plane.
    gl_Position = (vFlags & ${HIDDEN}u) != 0u ? vec4(0.0, 0.0, 2.0, 1.0) : projectionMatrix * view;
}`;

export const meshFragment = /* glsl */ `
precision highp float;
precision highp int;
flat in uint vPiece;
flat in uint vFace;
flat in uint vFlags;
in vec3 vView;
in vec3 vCorner;
in vec3 vWorld;
uniform vec3 clipMin;
uniform vec3 clipMax;
uniform vec3 upInView;
uniform bool wireframe;
layout(location = 0) out uvec2 seen;

void main() {
    if (any(lessThan(vWorld, clipMin)) || any(greaterThan(vWorld, clipMax))) discard;
    // One pixel of four of a piece that is seen through: four samples make a quarter of its colour.
    if ((vFlags & ${XRAY}u) != 0u && ((int(gl_FragCoord.x) | int(gl_FragCoord.y)) & 1) != 0) discard;
    vec3 normal = cross(dFdx(vView), dFdy(vView));
    normal *= inversesqrt(max(dot(normal, normal), 1e-30));
    float facing = abs(dot(normal, normalize(vView)));
    float shade = 0.5 + 0.42 * facing + 0.08 * abs(dot(normal, upInView));
    if (wireframe) {
        vec3 pixels = vCorner / max(fwidth(vCorner), vec3(1e-9));
        float edge = min(pixels.x, min(pixels.y, pixels.z));
        shade *= 0.35 + 0.65 * smoothstep(0.4, 1.4, edge);
    }
    seen = uvec2(((vPiece + 1u) << 8) | uint(clamp(shade, 0.0, 1.0) * 255.0 + 0.5), vFace);
}`;

export const pictureVertex = /* glsl */ `
in vec3 position;
void main() {
    gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

export const pictureFragment = /* glsl */ `
precision highp float;
precision highp int;
precision highp usampler2D;
uniform usampler2D seen;
uniform highp sampler2D depth;
uniform sampler2D pieceColors;
uniform usampler2D pieceMarks;
uniform usampler2D faceMarks;
uniform bool hasFaceMarks;
uniform bool real;
uniform sampler2D faceColors;
uniform bool hasFaceColors;
uniform sampler2D photograph;
uniform highp sampler2D photographDepth;
uniform bool hasPhotograph;
uniform mat4 worldFromClip;
uniform mat4 photographFromWorld;
uniform vec2 photographNearFar;
uniform bool outlines;
uniform bool anyMarked;
uniform int samples;
uniform float scale;
uniform uint hovered;
uniform vec3 background;
uniform vec3 accent;
uniform vec3 paint;
layout(location = 0) out vec4 color;

uint pieceAt(ivec2 at) { return texelFetch(seen, at, 0).r >> 8; }

uint marksOf(uint piece) {
    if (piece == 0u) return 0u;
    uint i = piece - 1u;
    return texelFetch(pieceMarks, ivec2(i % ${PIECE_WIDTH}u, i / ${PIECE_WIDTH}u), 0).r;
}

bool isMarked(uint piece) { return (marksOf(piece) & ${SELECTED | PREVIEWED}u) != 0u; }

bool hoveredAt(ivec2 at) { return pieceAt(at) == hovered + 1u; }

// True on lines of a pattern over the picture, not over the scene; lengths are CSS pixels.
bool onLine(float across, float period, float width) { return mod(across, period * scale) < width * scale; }

// The photograph where it shows what lies at a place of the view, else the colour that is given.
vec3 photographed(ivec2 at, vec3 rgb) {
    vec3 clip = vec3((vec2(at) + 0.5) / vec2(textureSize(depth, 0)), texelFetch(depth, at, 0).r) * 2.0 - 1.0;
    vec4 world = worldFromClip * vec4(clip, 1.0);
    vec4 there = photographFromWorld * vec4(world.xyz / world.w, 1.0);
    vec2 uv = there.xy / there.w * 0.5 + 0.5;
    if (there.w <= photographNearFar.x || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return rgb;
    float n = photographNearFar.x, f = photographNearFar.y;
    float seen = 2.0 * n * f / (f + n - (2.0 * texture(photographDepth, uv).r - 1.0) * (f - n));
    return there.w > seen * 1.01 + 0.01 ? rgb : texture(photograph, uv).rgb;
}

// The colour of a surface as it looks, lit by the view's own light where no photograph shows it.
vec3 look(ivec2 at, uvec2 here) {
    vec3 own = hasFaceColors ? texelFetch(faceColors, ivec2(here.g % ${MARK_WIDTH}u, here.g / ${MARK_WIDTH}u), 0).rgb : vec3(0.72);
    own *= float(here.r & 255u) / 255.0;
    return hasPhotograph ? photographed(at, own) : own;
}

// The colour of what is seen there. Hatching says that it has no label in this layer, or is marked; its own colour stays between the lines.
vec3 surface(ivec2 at, uvec2 here, bool marked) {
    uint i = (here.r >> 8) - 1u;
    vec4 own = texelFetch(pieceColors, ivec2(i % ${PIECE_WIDTH}u, i / ${PIECE_WIDTH}u), 0);
    vec3 rgb = real ? look(at, here) : own.rgb * (float(here.r & 255u) / 255.0);
    if (own.a < 0.9 && onLine(gl_FragCoord.x + gl_FragCoord.y, 10.0, own.a < 0.25 ? 1.5 : 2.5)) rgb = own.a < 0.25 ? rgb * (real ? 0.94 : 0.88) : mix(rgb, vec3(1.0), real ? 0.25 : 0.5);
    if (hasFaceMarks && texelFetch(faceMarks, ivec2(here.g % ${MARK_WIDTH}u, here.g / ${MARK_WIDTH}u), 0).r != 0u) rgb = mix(rgb, paint, 0.65);
    if (marked && onLine(gl_FragCoord.x - gl_FragCoord.y, 12.0, 2.0)) rgb = mix(rgb, accent, 0.75);
    return rgb;
}

// True when a place so far away, in samples, is of another piece that is marked otherwise.
bool borders(ivec2 at, ivec2 size, int reach, uint piece, bool marked) {
    for (int i = 0; i < 4; i++) {
        ivec2 way = i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5);
        uint other = pieceAt(clamp(at + way * reach, ivec2(0), size - 1));
        if (other != piece && isMarked(other) != marked) return true;
    }
    return false;
}

vec3 colorAt(ivec2 at, ivec2 size) {
    uvec2 here = texelFetch(seen, at, 0).rg;
    uint piece = here.r >> 8;
    bool marked = anyMarked && isMarked(piece);
    vec3 rgb = piece == 0u ? background : surface(at, here, marked);
    int thin = samples * int(scale + 0.5);
    // What is marked has a line of two pixels within, and a dark one around it.
    if (marked && borders(at, size, 2 * thin, piece, true)) return accent;
    if (anyMarked && !marked && borders(at, size, thin, piece, false)) return vec3(0.06);
    ivec2 right = min(at + ivec2(thin, 0), size - 1);
    ivec2 above = min(at + ivec2(0, thin), size - 1);
    if (hovered != ${0xffffffff}u) {
        bool over = piece == hovered + 1u;
        if (hoveredAt(right) != over || hoveredAt(above) != over) return vec3(onLine(gl_FragCoord.x - gl_FragCoord.y, 8.0, 4.0) ? 1.0 : 0.0);
    }
    if (outlines && (pieceAt(min(at + ivec2(1, 0), size - 1)) != piece || pieceAt(min(at + ivec2(0, 1), size - 1)) != piece)) rgb *= 0.55;
    return rgb;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) * samples;
    ivec2 size = textureSize(seen, 0);
    vec3 sum = vec3(0.0);
    float nearest = 1.0;
    for (int y = 0; y < samples; y++) {
        for (int x = 0; x < samples; x++) {
            sum += colorAt(at + ivec2(x, y), size);
            nearest = min(nearest, texelFetch(depth, at + ivec2(x, y), 0).r);
        }
    }
    color = vec4(sum / float(samples * samples), 1.0);
    gl_FragDepth = nearest;
}`;
