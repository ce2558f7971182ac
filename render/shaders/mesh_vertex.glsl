// A triangle corner from the subject's frame to clip space, with what the fragment stages need.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_color;
layout(location = 3) in float a_scalar;
layout(location = 4) in vec3 a_edge;
uniform mat4 u_view;
uniform mat4 u_projection;
uniform float u_inset;  // [m] against the normal
out vec3 v_position;    // subject frame
out vec3 v_normal;
out vec3 v_color;       // linear
out float v_scalar;
out vec3 v_edge;
out float v_distance;   // along the view axis [m]

vec3 linear_from_srgb(vec3 code) {
  return mix(code / 12.92, pow((code + 0.055) / 1.055, vec3(2.4)), step(vec3(0.04045), code));
}

void main() {
  v_position = a_position - u_inset * a_normal;
  vec4 seen = u_view * vec4(v_position, 1.0);
  v_normal = a_normal;
  v_color = linear_from_srgb(a_color.rgb);
  v_scalar = a_scalar;
  v_edge = a_edge;
  v_distance = -seen.z;
  gl_Position = u_projection * seen;
}
