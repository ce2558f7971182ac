// Averages the occlusion over 4 x 4 pixels, but not across an edge in depth.
uniform sampler2D u_geometry;
uniform sampler2D u_occlusion;
out float o_open;

const float kSameSurface = 0.012;  // [m]

void main() {
  ivec2 centre = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(u_occlusion, 0) - 1;
  float distance = texelFetch(u_geometry, centre, 0).w;
  float sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      ivec2 at = clamp(centre + ivec2(x, y), ivec2(0), last);
      float weight = 1e-4 + max(0.0, 1.0 - abs(texelFetch(u_geometry, at, 0).w - distance) / kSameSurface);
      sum += weight * texelFetch(u_occlusion, at, 0).r;
      weights += weight;
    }
  o_open = sum / weights;
}
