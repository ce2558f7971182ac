// Shading of fabric, body and ground in linear RGB: a key light with soft shadows, a fill light, a hemisphere of ambient
// light dimmed by the occlusion, and the sheen of fibres at grazing angles.
in vec3 v_position;
in vec3 v_normal;
in vec3 v_color;
in float v_scalar;
in vec3 v_edge;
in float v_distance;
uniform int u_material;      // 0 fabric, 1 body, 2 ground
uniform int u_paint;         // 0 own colour, 1 colour map of the scalar
uniform float u_line_width;  // [m] of the marked edges
uniform float u_line_pixels; // least width [px]
uniform float u_line_strength;
uniform vec3 u_eye;          // subject frame
uniform vec3 u_key;          // towards the light
uniform vec3 u_fill;
uniform vec3 u_up;           // hemisphere's pole
uniform mat4 u_light;        // subject frame to the shadow map's texture space
uniform float u_shadow_texel;  // [m]
uniform vec3 u_ground_centre;
uniform float u_ground_radius;
uniform sampler2D u_geometry;
uniform sampler2D u_occlusion;
uniform sampler2D u_color_map;
uniform sampler2DShadow u_shadow;
out vec4 o_color;

const float kKey = 0.92, kFill = 0.16, kSky = 0.42, kEarth = 0.22, kSheen = 0.10;
const float kMapKey = 0.34, kMapBase = 0.68;  // coloured overlays: flatter light, so that colours stay those of the legend
const float kShoulder = 0.80;                 // above it, light is compressed instead of clipped
const float kGroundShadow = 0.74, kGroundContact = 0.5;  // darkest factor of each on the ground
const int kShadowReach = 2;                   // 5 x 5 taps, each a bilinear comparison

float key_light(vec3 n) {
  float lit = dot(n, u_key);
  // Off the surface by more where the light grazes it: no self-shadow stripes.
  vec3 at = v_position + n * u_shadow_texel * (1.5 + 3.0 * (1.0 - clamp(lit, 0.0, 1.0)));
  vec3 map = (u_light * vec4(at, 1.0)).xyz;
  vec2 texel = 1.6 / vec2(textureSize(u_shadow, 0));
  float reach = float(kShadowReach);
  float corners = texture(u_shadow, vec3(map.xy + vec2(-reach, -reach) * texel, map.z)) +
                  texture(u_shadow, vec3(map.xy + vec2(reach, -reach) * texel, map.z)) +
                  texture(u_shadow, vec3(map.xy + vec2(-reach, reach) * texel, map.z)) +
                  texture(u_shadow, vec3(map.xy + vec2(reach, reach) * texel, map.z));
  if (corners == 0.0 || corners == 4.0) return 0.25 * corners;  // away from a shadow's edge: four of five pixels
  float sum = 0.0;
  for (int y = -kShadowReach; y <= kShadowReach; ++y)
    for (int x = -kShadowReach; x <= kShadowReach; ++x)
      sum += texture(u_shadow, vec3(map.xy + vec2(x, y) * texel, map.z));
  return sum / float((2 * kShadowReach + 1) * (2 * kShadowReach + 1));
}

// The occlusion of this surface, not of the one behind it that shares the pixel.
float openness() {
  ivec2 centre = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(u_occlusion, 0) - 1;
  float sum = 0.0, weights = 0.0;
  const ivec2 around[5] = ivec2[5](ivec2(0), ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
  for (int i = 0; i < 5; ++i) {
    ivec2 at = clamp(centre + around[i], ivec2(0), last);
    float away = abs(texelFetch(u_geometry, at, 0).w - v_distance);
    float weight = 1e-5 + exp(-away * 150.0);
    sum += weight * texelFetch(u_occlusion, at, 0).r;
    weights += weight;
  }
  return sum / weights;
}

vec3 shoulder(vec3 light) {
  vec3 over = 1.0 - (1.0 - kShoulder) * exp(-(light - kShoulder) / (1.0 - kShoulder));
  return mix(light, over, step(vec3(kShoulder), light));
}

void main() {
  if (u_material == 2) {
    float fade = 1.0 - smoothstep(0.20, 1.0, length(v_position - u_ground_centre) / u_ground_radius);
    o_color = vec4(backdrop(gl_FragCoord.xy), 1.0);
    if (fade > 0.0) {
      float shade = mix(1.0, mix(kGroundShadow, 1.0, key_light(vec3(0, 1, 0))), fade);
      float contact = mix(1.0, mix(kGroundContact, 1.0, openness()), fade);
      o_color.rgb *= shade * contact;
    }
    return;
  }
  vec3 eye = normalize(u_eye - v_position);
  vec3 n = normalize(v_normal);
  bool right_side = gl_FrontFacing || u_material == 1;
  if (!right_side) n = -n;
  vec3 albedo = u_paint == 1 ? texture(u_color_map, vec2(v_scalar, 0.5)).rgb : v_color;
  if (!right_side && u_paint == 0) {
    // The wrong side: paler and less saturated, darker for colours that are near white already.
    float grey = dot(albedo, vec3(0.2126, 0.7152, 0.0722));
    vec3 pale = mix(albedo, vec3(grey), 0.45);
    albedo = grey > 0.6 ? pale * 0.72 : mix(pale, vec3(1.0), 0.22);
  }
  vec3 wide = max(fwidth(v_edge), vec3(1e-6));
  vec3 lines = 1.0 - smoothstep(max(vec3(u_line_width), u_line_pixels * wide) - 0.5 * wide,
                                max(vec3(u_line_width), u_line_pixels * wide) + 0.5 * wide, v_edge);
  float line = max(lines.x, max(lines.y, lines.z));
  // A seam is a small valley between two rolls: a bright rim next to the dark line.
  vec3 rims = exp(-pow((v_edge - 3.0 * u_line_width) / (1.2 * u_line_width), vec3(2.0)));
  float rim = max(rims.x, max(rims.y, rims.z)) * (1.0 - line);
  float open = openness();
  float lit = max(dot(n, u_key), 0.0);
  if (lit > 0.0) lit *= key_light(n);
  float fill = max(dot(n, u_fill), 0.0);
  float ambient = mix(kEarth, kSky, 0.5 + 0.5 * dot(n, u_up)) * open * open;
  vec3 color;
  if (u_paint == 1) {
    color = albedo * (kMapBase * mix(0.45, 1.0, open * open) + kMapKey * lit);
  } else {
    float sheen = u_material == 0 ? kSheen * pow(1.0 - max(dot(n, eye), 0.0), 3.0) * open : 0.0;
    color = albedo * (kKey * lit + kFill * fill * open + ambient) + sheen * mix(albedo, vec3(1.0), 0.35);
    color *= 1.0 + 0.06 * rim * step(u_line_strength, 0.6);
  }
  color *= 1.0 - u_line_strength * line;
  o_color = vec4(shoulder(color), 1.0);
}
