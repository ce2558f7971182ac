// The key light's depth map: depth only.
void main() {}
