out vec4 o_color;

void main() { o_color = vec4(backdrop(gl_FragCoord.xy), 1.0); }
