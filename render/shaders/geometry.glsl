// What the eye sees first: normal (towards the eye, view space) and distance along the view axis.
in vec3 v_normal;
in float v_distance;
uniform mat4 u_view;
out vec4 o_geometry;

void main() {
  vec3 n = normalize(mat3(u_view) * v_normal);
  o_geometry = vec4(gl_FrontFacing ? n : -n, v_distance);
}
