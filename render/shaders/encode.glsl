// Averages u_scale x u_scale linear pixels and encodes them as sRGB (IEC 61966-2-1).
uniform sampler2D u_linear;
uniform int u_scale;
out vec4 o_color;

void main() {
  vec3 sum = vec3(0.0);
  ivec2 corner = ivec2(gl_FragCoord.xy) * u_scale;
  for (int y = 0; y < u_scale; ++y)
    for (int x = 0; x < u_scale; ++x) sum += texelFetch(u_linear, corner + ivec2(x, y), 0).rgb;
  vec3 c = clamp(sum / float(u_scale * u_scale), 0.0, 1.0);
  vec3 encoded = mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
  o_color = vec4(encoded, 1.0);
}
