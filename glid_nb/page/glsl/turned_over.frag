// Triangles that a map of a mesh has turned over, in one colour; premultiplied by alpha.

uniform vec4 mark;

void main() {
  gl_FragColor = vec4(mark.rgb, 1.0) * mark.a;
}
