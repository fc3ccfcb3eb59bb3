// SPDX-License-Identifier: BSD-3-Clause
//
// The shader of the cloth, GLSL 1.20. The mesh is so fine that light is worked out at its vertices, for both sides; a
// pixel takes that of the side it shows. In software rendering pixels are what takes time.
//
// Light comes over the viewer's left shoulder (direct), from above and, less, from below. It is added up as it is in
// nature, and shown with a gamma of 2: colours of the fabric are multiplied by the root. What lies deep in a fold gets
// less light. The direct light that falls on the other side shines through (translucency), and fibres that stick out of
// the cloth catch light at grazing angles (sheen).
#pragma once

namespace curtain_rviz {

// Texture coordinates 0: the place on the cloth [m]; 1: the hollow; 2: the layer's value.
constexpr char kVertexShader[] = R"(#version 120
uniform mat4 world_view_projection;
uniform mat4 world_view;
uniform mat4 view;
uniform float repeats_per_metre;
uniform float ranges_per_value;  // 0: no layer
uniform float sheen;
uniform float translucency;
varying vec2 place;
varying vec4 front, back;        // light, and what is added to the colour

const vec3 to_light = vec3(-0.53, 0.62, 0.58);
const vec3 direct = vec3(1.30, 1.24, 1.14);
const vec3 from_above = vec3(0.40, 0.43, 0.48);
const vec3 from_below = vec3(0.20, 0.18, 0.17);

vec4 lit(vec3 normal, vec3 up, vec3 to_eye, float hollow) {
  float open = 1.0 - 0.75 * clamp(hollow, 0.0, 1.0);
  float facing = dot(normal, to_light);
  float onto = max(facing, 0.0) * (0.35 + 0.65 * open);
  vec3 light = open * mix(from_below, from_above, 0.5 + 0.5 * dot(normal, up));
  light += direct * (onto * (1.0 - 0.3 * translucency) + 0.6 * translucency * max(-facing, 0.0));
  float graze = 1.0 - clamp(dot(normal, to_eye), 0.0, 1.0);
  float gloss = max(dot(normal, normalize(to_light + to_eye)), 0.0);
  gloss *= gloss;
  gloss *= gloss;
  float shine = sheen * open * (0.22 * graze * graze * graze * (0.4 + max(facing, 0.0)) + 0.07 * gloss * gloss);
  return vec4(sqrt(light), shine);
}

void main() {
  gl_Position = world_view_projection * gl_Vertex;
  vec3 to_eye = -normalize((world_view * gl_Vertex).xyz);
  vec3 normal = normalize(mat3(world_view[0].xyz, world_view[1].xyz, world_view[2].xyz) * gl_Normal);
  vec3 up = view[2].xyz;
  front = lit(normal, up, to_eye, gl_MultiTexCoord1.x);
  back = lit(-normal, up, to_eye, -gl_MultiTexCoord1.x);
  place = repeats_per_metre * gl_MultiTexCoord0.xy;
  if (ranges_per_value > 0.0) {
    // The colours of a layer are to be read: less shading.
    place = vec2(clamp(gl_MultiTexCoord2.x * ranges_per_value, 0.002, 0.998), 0.5);
    front = vec4(mix(vec3(1.0), front.rgb, 0.6), 0.0);
    back = vec4(mix(vec3(1.0), back.rgb, 0.6), 0.0);
  }
}
)";

// Pictures that are drawn into textures stand on their heads, and triangles turn the other way.
constexpr char kFragmentShader[] = R"(#version 120
uniform sampler2D colours;
uniform float upright;  // 1, or -1: upside down
varying vec2 place;
varying vec4 front, back;

void main() {
  vec4 light = gl_FrontFacing == (upright > 0.0) ? front : back;
  gl_FragColor = vec4(texture2D(colours, place).rgb * light.rgb + light.aaa, 1.0);
}
)";

}  // namespace curtain_rviz
