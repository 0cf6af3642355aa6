// Draws the ground in shades that tell how the air above was seen: light where a beam was low, darker where all beams
// were high, and hatched where there was no beam. Land and water have their own shades.
uniform usampler2D coverage;
uniform vec2 columns; // columns of the grid along x and y
uniform float columnsATexel; // columns of the grid that a texel covers along each side
uniform vec2 halfSize; // half of the grid's width and height, in meters
uniform float ground; // drawn height of the ground
uniform vec3 page, hatch;
uniform vec3 landShades[4], waterShades[4]; // not seen, seen from high up only, seen from low down, beyond the grid
uniform sampler2D water; // share of water
uniform vec2 waterHalf; // half of the width and height that the texture covers, in meters
uniform float hatchScale;
out vec4 color;

// Returns the share of water at a place. A shore is a pixel wide at any zoom.
float waterAt(vec2 at) {
    float share = texture(water, 0.5 + vec2(0.5, -0.5) * at / waterHalf).r - 0.5;
    return clamp(0.5 + share / max(fwidth(share), 1e-3), 0.0, 1.0);
}

void main() {
    // Show the color of the page where the ray does not meet the ground.
    vec3 start = rayStart(), along = rayStep();
    float depth = (ground - start.z) / along.z;
    if (missesGround(along, depth)) {
        color = vec4(page, 1.0);
        return;
    }
    // Find where the ray meets the ground, in meters and as a share of the grid's width and height.
    vec2 at = (start + depth * along).xy;
    vec2 place = (at + halfSize) / (2.0 * halfSize);
    float isWater = waterAt(at);
    // Fade the ground beyond the grid into the page, because nothing is known there.
    if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(1.0)))) {
        float away = length(max(abs(at) - halfSize, 0.0)) / max(halfSize.x, halfSize.y);
        color = vec4(mix(mix(landShades[3], waterShades[3], isWater), page, clamp(away / 1.5, 0.0, 1.0)), 1.0);
        return;
    }
    // Take the shade of the column's state.
    uint state = texelFetch(coverage, ivec2(place * columns / columnsATexel), 0).r;
    vec3 shade = mix(landShades[state], waterShades[state], isWater);
    color = vec4(state == 0u ? mix(shade, hatch, hatchAt(hatchScale)) : shade, 1.0);
}
