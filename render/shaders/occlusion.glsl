// Screen-space ambient occlusion: the share of a hemisphere of radius u_radius that is hidden by what the eye sees.
uniform sampler2D u_geometry;
uniform vec2 u_tangent;    // of half the field of view, x and y
uniform vec2 u_shift;      // of the picture's centre, in clip space
uniform vec2 u_size;       // [px]
uniform float u_radius;    // [m]
out float o_open;

const int kSamples = 20;
const float kBias = 0.0025;       // [m] a surface does not hide itself
const float kGolden = 2.39996323; // [rad] spiral step that never repeats a direction

vec3 view_position(vec2 pixel, float distance) {
  vec2 clip = 2.0 * pixel / u_size - 1.0 - u_shift;
  return vec3(clip * u_tangent, -1.0) * distance;
}

void main() {
  vec4 here = texelFetch(u_geometry, ivec2(gl_FragCoord.xy), 0);
  o_open = 1.0;
  if (here.w <= 0.0) return;
  vec3 p = view_position(gl_FragCoord.xy, here.w);
  vec3 n = normalize(here.xyz);
  vec3 side = normalize(abs(n.y) < 0.9 ? cross(n, vec3(0, 1, 0)) : cross(n, vec3(1, 0, 0)));
  vec3 other = cross(n, side);
  // A 4 x 4 pattern of turns, which the 4 x 4 blur takes out again.
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float turn = float((cell.x * 4 + cell.y * 7 + (cell.x ^ cell.y) * 5) & 15) / 16.0;
  float hidden = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    float u = (float(i) + fract(turn * 5.0)) / float(kSamples);
    float angle = kGolden * float(i) + 6.2831853 * turn;
    float rise = sqrt(1.0 - 0.95 * u);
    float spread = sqrt(1.0 - rise * rise);
    float t = (float((i * 7) % kSamples) + 0.5) / float(kSamples);
    float reach = u_radius * mix(0.06, 1.0, t * t);
    vec3 q = p + reach * (rise * n + spread * (cos(angle) * side + sin(angle) * other));
    vec2 clip = q.xy / (-q.z * u_tangent) + u_shift;
    ivec2 at = ivec2((clip * 0.5 + 0.5) * u_size);
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(u_size)))) continue;
    float seen = texelFetch(u_geometry, at, 0).w;
    if (seen <= 0.0) continue;
    float depth = -q.z - seen;
    hidden += step(kBias, depth) * smoothstep(0.0, 1.0, u_radius / max(abs(here.w - seen), 1e-4));
  }
  o_open = 1.0 - hidden / float(kSamples);
}
