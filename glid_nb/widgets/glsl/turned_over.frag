// Triangles that a map of a mesh has turned over: one colour. Premultiplied by alpha.

precision highp float;

uniform vec4 mark;

void main() {
  gl_FragColor = vec4(mark.rgb, 1.0) * mark.a;
}
