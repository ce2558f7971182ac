// Shading of fabric, body and ground in linear RGB: a key light with soft shadows and a hemisphere of ambient light
// dimmed by the occlusion (both from light.glsl), a fill light, and the sheen of fibres at grazing angles.
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
uniform float u_line_strength; // how much darker
uniform float u_rim_strength;  // how much brighter beside the line
uniform vec3 u_eye;          // subject frame
uniform vec3 u_key;          // towards the light
uniform vec3 u_fill;
uniform vec3 u_up;           // hemisphere's pole
uniform vec3 u_ground_centre;
uniform float u_ground_radius;
uniform sampler2D u_light;     // of light.glsl
uniform sampler2D u_color_map;
out vec4 o_color;

const float kKey = 1.04, kFill = 0.14, kSky = 0.37, kEarth = 0.16, kSheen = 0.10;
const float kMapKey = 0.34, kMapBase = 0.68;  // coloured overlays: flatter light, so that colours stay those of the legend
const float kShoulder = 0.80;                 // above it, light is compressed instead of clipped
const float kGroundShadow = 0.74, kGroundContact = 0.5;  // darkest factor of each on the ground

// Openness and key light of this surface, not of the one behind it that shares the pixel.
vec2 light_here() {
  ivec2 centre = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(u_light, 0) - 1;
  vec2 sum = vec2(0.0);
  float weights = 0.0;
  const ivec2 around[5] = ivec2[5](ivec2(0), ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
  for (int i = 0; i < 5; ++i) {
    vec4 light = texelFetch(u_light, clamp(centre + around[i], ivec2(0), last), 0);
    float weight = 1e-5 + (i == 0 ? 4.0 : 1.0) * exp(-150.0 * abs(light.w - v_distance));
    sum += weight * light.xy;
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
      vec2 light = light_here();
      o_color.rgb *= mix(1.0, mix(kGroundContact, 1.0, light.x) * mix(kGroundShadow, 1.0, light.y), fade);
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
  vec2 light = light_here();
  float open = light.x;
  float lit = light.y * max(dot(n, u_key), 0.0);
  float fill = max(dot(n, u_fill), 0.0);
  float ambient = mix(kEarth, kSky, 0.5 + 0.5 * dot(n, u_up)) * open * open;
  vec3 color;
  if (u_paint == 1) {
    color = albedo * (kMapBase * mix(0.45, 1.0, open * open) + kMapKey * lit);
  } else {
    float sheen = u_material == 0 ? kSheen * pow(1.0 - max(dot(n, eye), 0.0), 3.0) * open : 0.0;
    color = albedo * (kKey * lit + kFill * fill * open + ambient) + sheen * mix(albedo, vec3(1.0), 0.35);
    color *= 1.0 + u_rim_strength * rim;
  }
  color *= 1.0 - u_line_strength * line;
  o_color = vec4(shoulder(color), 1.0);
}
