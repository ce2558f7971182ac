// The studio background: light, a little darker towards the foot of the picture. Linear RGB.
uniform vec2 u_size;  // [px]

vec3 backdrop(vec2 pixel) {
  vec2 at = pixel / u_size;
  float centre = length(at - vec2(0.5, 0.62));
  return mix(vec3(0.905, 0.912, 0.920), vec3(0.700, 0.708, 0.720), smoothstep(0.0, 0.95, centre));
}
