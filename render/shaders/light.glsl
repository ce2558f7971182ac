// What light reaches each pixel of what the eye sees: the ambient occlusion averaged over 4 x 4 pixels (but not across
// an edge in depth), and the share of the key light that no shadow takes. Once a pixel, whatever the triangles' size.
uniform sampler2D u_geometry;
uniform sampler2D u_occlusion;
uniform sampler2DShadow u_shadow;
uniform vec2 u_tangent;        // of half the field of view, x and y
uniform vec2 u_shift;          // of the picture's centre, in clip space
uniform vec2 u_size;           // [px]
uniform vec3 u_key;            // towards the light, view space
uniform mat4 u_light;          // view space to the shadow map's texture space
uniform float u_shadow_texel;  // [m]
out vec4 o_light;              // openness, key light, 0, distance along the view axis [m]

const float kSameSurface = 0.012;  // [m]
const float kSoftness = 1.6;       // [texels] between taps
const int kReach = 2;              // 5 x 5 taps, each a bilinear comparison

float openness(ivec2 centre, float distance) {
  ivec2 last = textureSize(u_occlusion, 0) - 1;
  float sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      ivec2 at = clamp(centre + ivec2(x, y), ivec2(0), last);
      float weight = 1e-4 + max(0.0, 1.0 - abs(texelFetch(u_geometry, at, 0).w - distance) / kSameSurface);
      sum += weight * texelFetch(u_occlusion, at, 0).r;
      weights += weight;
    }
  return sum / weights;
}

float key_light(vec3 position, vec3 n) {
  // Off the surface by more where the light grazes it: no self-shadow stripes.
  vec3 off = position + n * u_shadow_texel * (1.5 + 3.0 * (1.0 - clamp(dot(n, u_key), 0.0, 1.0)));
  vec3 map = (u_light * vec4(off, 1.0)).xyz;
  vec2 texel = kSoftness / vec2(textureSize(u_shadow, 0));
  float reach = float(kReach);
  float corners = texture(u_shadow, vec3(map.xy + vec2(-reach, -reach) * texel, map.z)) +
                  texture(u_shadow, vec3(map.xy + vec2(reach, -reach) * texel, map.z)) +
                  texture(u_shadow, vec3(map.xy + vec2(-reach, reach) * texel, map.z)) +
                  texture(u_shadow, vec3(map.xy + vec2(reach, reach) * texel, map.z));
  if (corners == 0.0 || corners == 4.0) return 0.25 * corners;  // away from a shadow's edge: most pixels
  float sum = 0.0;
  for (int y = -kReach; y <= kReach; ++y)
    for (int x = -kReach; x <= kReach; ++x)
      sum += texture(u_shadow, vec3(map.xy + vec2(x, y) * texel, map.z));
  return sum / float((2 * kReach + 1) * (2 * kReach + 1));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 here = texelFetch(u_geometry, pixel, 0);
  o_light = vec4(1.0, 1.0, 0.0, here.w);
  if (here.w <= 0.0) return;
  vec2 clip = 2.0 * gl_FragCoord.xy / u_size - 1.0 - u_shift;
  vec3 position = vec3(clip * u_tangent, -1.0) * here.w;
  o_light.xy = vec2(openness(pixel, here.w), key_light(position, normalize(here.xyz)));
}
