// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The paper's fragment shader: red is the intensity of equations (2) to (5), green and blue are the
// depth of equations (6) to (9). Surfaces look as in glidar/render/surface.cpp.

in vec3 at_normal;
in float depth_steps;
in vec3 ray;
#ifdef WRITES_DEPTH
in float clip_depth;
#endif
layout(location = 0) out vec4 pixel;

uniform vec3 attenuation;  // constant, linear, quadratic

// What light comes back: always, times n.h, and times (n.h)^shininess; all of it after textures.
struct Shares {
  float ambient;
  float diffuse;
  float specular;
};
uniform float shininess;

#ifdef HAS_TEXTURES
const float kShortest = 1e-6;

uniform float scene_ambient;
uniform vec3 ambient;
uniform vec3 diffuse;
uniform vec3 specular;
uniform int first_triangle;
uniform samplerBuffer flat_normals;  // per triangle, in the order of the draw

in vec2 at_uv_0;
in vec2 at_uv_1;
in vec4 at_tangent;
in vec3 at_colour;

struct UsedTexture {
  bool is_used;
  int uv_set;
  TextureUse use;
};

uniform UsedTexture diffuse_use;
uniform UsedTexture specular_use;
uniform UsedTexture mask_use;
uniform UsedTexture normal_use;
uniform sampler2D diffuse_texture;
uniform sampler2D specular_texture;
uniform sampler2D mask_texture;
uniform sampler2D normal_texture;
uniform float opacity;
uniform float cutoff;        // 0: solid
uniform bool mask_is_alpha;  // else grey or red
uniform float normal_scale;
uniform bool has_tangents;

// Without normals, or where they cancel out, that of the triangle.
vec3 smooth_normal() {
  float size = length(at_normal);
  if (size > kShortest) return at_normal / size;
  return texelFetch(flat_normals, first_triangle + gl_PrimitiveID).xyz;
}

vec4 used_texel(sampler2D image, UsedTexture used) {
  if (!used.is_used) return vec4(1.0);
  return texel_at(image, used.use, used.uv_set == 0 ? at_uv_0 : at_uv_1);
}

bool is_cut_out() {
  if (!(cutoff > 0.0)) return false;
  vec4 mask = used_texel(mask_texture, mask_use);
  return opacity * (mask_is_alpha ? mask.a : mask.r) < cutoff;
}

vec3 shading_normal() {
  vec3 smooth_one = smooth_normal();
  if (!normal_use.is_used || !has_tangents) return smooth_one;
  vec3 along = at_tangent.xyz - smooth_one * dot(smooth_one, at_tangent.xyz);
  float size = length(along);
  if (!(size > kShortest)) return smooth_one;
  vec3 tangent = along / size;
  vec3 bitangent = (at_tangent.w < 0.0 ? -1.0 : 1.0) * cross(smooth_one, tangent);
  vec3 local = 2.0 * used_texel(normal_texture, normal_use).rgb - 1.0;  // n = 2 rgb - 1
  vec3 bent = tangent * (local.x * normal_scale) + bitangent * (local.y * normal_scale) +
              smooth_one * local.z;
  float bent_size = length(bent);
  return bent_size > kShortest ? bent / bent_size : smooth_one;
}

// Cosine between the shading normal and the ray, whose length is given squared.
float cosine_to_ray(float squared) {
  return dot(shading_normal(), ray) * inversesqrt(squared);
}

// Weights of Rec. ITU-R BT.709.
float luminance(vec3 rgb) {
  return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

Shares shares() {
  vec3 tint = used_texel(diffuse_texture, diffuse_use).rgb * at_colour;
  vec3 gloss = used_texel(specular_texture, specular_use).rgb;
  return Shares(scene_ambient * luminance(ambient * tint), luminance(diffuse * tint),
                luminance(specular * gloss));
}
#else
// Constant, so it is computed on the CPU.
uniform vec3 plain_shares;

float cosine_to_ray(float squared) {
  return dot(at_normal, ray) * inversesqrt(dot(at_normal, at_normal) * squared);
}

Shares shares() {
  return Shares(plain_shares.x, plain_shares.y, plain_shares.z);
}
#endif

void main() {
#ifdef HAS_TEXTURES
  if (is_cut_out()) discard;
#endif
  float steps = clamp(depth_steps, 0.0, 65535.0);
  float squared = dot(ray, ray);
  float d = sqrt(squared);
  float a = 1.0 / (attenuation.x + attenuation.y * d + attenuation.z * d * d);  // equation (3)

  // Equation (2): h points along -ray; the normal is turned to the sensor.
  float along = cosine_to_ray(squared);
  float n_dot_h = max(gl_FrontFacing ? -along : along, 0.0);
  Shares light = shares();
  float c = light.ambient + light.diffuse * n_dot_h;  // equation (5)
#ifdef IS_SHINY
  if (light.specular > 0.0) {
    c += light.specular * (shininess > 0.0 ? pow(n_dot_h, shininess) : 1.0);
  }
#endif

  // Equations (6) and (7); a byte k is written as k / 255, which the target rounds to k.
  float high = floor(steps / 256.0);
  float low = floor(steps - 256.0 * high);
  pixel = vec4(a * c, high / 255.0, low / 255.0, 1.0);  // equation (4)
#ifdef WRITES_DEPTH
  gl_FragDepth = clip_depth * gl_FragCoord.w;
#endif
}
