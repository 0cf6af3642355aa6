// Returns the share of a pixel that thin diagonal lines cover, from the lower left to the upper right, as hatched() in
// render/image/shades.h. The lines are `scale` times as far apart as usual.
float hatchAt(float scale) {
    vec2 p = floor(pixel());
    float period = 9.0 * scale;
    float phase = mod(p.x + p.y, period);
    float distance = min(phase, period - phase) / 1.41421356;
    return clamp(0.5 * scale + 0.5 - distance, 0.0, 1.0);
}
