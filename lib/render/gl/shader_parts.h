// Pieces of shading programs that several of them have in common. goniochrome-rendering(7), "RENDERING".
#pragma once

#include <cstddef>
#include <string>

#include "render/effects.h"
#include "render/gl/gbuffer_shader.h"

namespace goniochrome::render {

// A GLSL constant, which needs a point or an exponent to be a float.
std::string glsl(double value);

// Where the weights of this point begin, and how far into its segment the view is.
inline constexpr const char* kWeight = R"(
int row, column = 0;
float t;
vec4 W(int slot) {
  ivec2 at = ivec2(column + 2 * slot, row);
  return texelFetch(weights, at, 0) + t * texelFetch(weights, at + ivec2(1, 0), 0);
}
)";

// The transmission of a coat, by brdf's form of the Fresnel reflectance; `index2` is the square of its index, 1 without
// a coat, where the amplitudes would be 0/0 at c = 0.
inline constexpr const char* kLetIn = R"(
float let_in(float c, float index2) {
  if (index2 <= 1.0) return 1.0;
  float contrast = index2 - 1.0, g = sqrt(contrast + c * c), s = c + g, p = index2 * c + g;
  float r_s = contrast / (s * s), r_p = contrast * ((index2 + 1.0) * c * c - 1.0) / (p * p);
  return 1.0 - 0.5 * (r_s * r_s + r_p * r_p);
}
)";

// The place where a ray meets the ground, from the eye of the environment, which is at 0 and saw it there.
inline constexpr const char* kProjectedGround = R"(uniform vec3 ground_eye;  // the viewer
uniform float ground_drop, reach;  // reach: see the G-buffer
bool meets_ground(vec3 from, vec3 ray) {
  return ground_drop > 0.0 && ray.y < 0.0 && from.y + ground_drop > -1e-3 * ground_drop;
}
vec3 on_ground(vec3 from, vec3 ray) { return from - max(from.y + ground_drop, 0.0) / ray.y * ray; }
)";

// The part of its light that the ground keeps beside the mesh, where a ray meets it, and the light that a white mesh
// sends there. WebGL 2 promises 16 textures, so that there is no room for it beside more lobes.
inline constexpr std::size_t kMostLobesOverShade = 8;
inline constexpr const char* kKeptLight = R"(uniform sampler2D ground_light;
uniform float ground_scale;  // 1 over its reach, see PageGroundLight; 0 for none
uniform vec2 ground_turn;  // cosine and sine by which the environment was turned
vec4 kept_light(vec3 at, float width) {  // the mean over a part of the ground that is so wide
  if (ground_scale == 0.0) return vec4(1.0, 1.0, 1.0, 0.0);
  vec2 p = clamp(ground_scale * vec2(dot(ground_turn, at.xz), ground_turn.x * at.z - ground_turn.y * at.x), -1e3, 1e3);
  float squared = 1.0 + dot(p, p), size = 0.5 * float(textureSize(ground_light, 0).x) * ground_scale * width;
  float texels = size / (squared * sqrt(squared));
  return textureLod(ground_light, 0.5 + 0.5 * p * inversesqrt(1.0 + p * p), log2(max(texels, 1.0)));
}
)";
inline constexpr const char* kMeshColor = "uniform vec3 mesh_color;  // reflectance of the paint in even light\n";
// The light of a lobe that the mesh and its ground leave on a page. `bands` are the bands 1 and 2 of the lobe itself;
// `occluded` holds those of the luminance that is lost, times the cosine toward it, about the mirror direction. The
// light itself has the mean cosine of the lobe. Bands tell little of sharp lobes. Their part that looks down sees the
// ground, and the rest keeps the share of a wider lobe: an axis near the horizon stands for either part 0.7 deviations
// off it. A logistic curve of 1.7 x is the normal distribution within 0.01, and a lobe is 2.4 deviations wide where it
// has half of its height. The maps show the ground as the eye of the environment saw it: seen from nearer by, a lobe
// covers less of it, as a sharper lobe did there.
inline constexpr const char* kOcclusion = R"(uniform sampler2D occlusion;
vec4 occluded;  // its last number is the light that a white mesh sends here
vec3 sent = vec3(0.0);  // that of the mesh
float tilted;  // 5/8 P_2(c), the band 2 of the cosine; its mean is 1/2
float depth = 0.0;  // of the point; 0 where no light is lost
float share = 1.0;  // of light that sharp lobes keep beside the ground
vec3 from;  // the point, as the eye of the environment has it
uniform int own_lamps;  // the first, which no shadow dims
float lit = 1.0;  // of the light of other lamps
vec3 left(vec3 light, float lost) {
  return sent + clamp(1.0 - lost / max(dot(luminance, light), 1e-6), 0.0, 4.0) * light;
}
vec3 sharp(samplerCube map, vec3 axis, float deviation) {
  float below = 1.0 / (1.0 + exp(min(1.7 * axis.y / deviation, 80.0)));  // its part that looks down
  vec3 up = vec3(axis.x, max(axis.y, 0.7 * deviation), axis.z);
  vec3 down = normalize(vec3(axis.x, min(axis.y, -0.7 * deviation), axis.z));
  if (depth == 0.0 || below < 0.01 || !meets_ground(from, down))
    return sent + share * textureLod(map, axis, 0.0).rgb;
  vec3 met = on_ground(from, down);
  // Solid angles of the ground are as cos/distance^2, where cos is height/distance.
  float away = distance(met, from), part = away / length(met);
  float exponent = (from.y + ground_drop) / (deviation * deviation * part * part * part * ground_drop);
  vec3 ground = kept_light(met, 2.4 * deviation * away * inversesqrt(-down.y)).rgb * ground_map(met, exponent);
  return sent + (below > 0.99 ? ground : mix(share * textureLod(map, up, 0.0).rgb, ground, below));
}
vec3 left(vec3 light, vec2 bands) {
  return left(light, (occluded.x + dot(bands, occluded.yz)) / (0.5 + bands.y * tilted));
}
)";
std::string luminance_constant();
// Statements that take the occlusion of a point, where r is known.
std::string occlusion_start(const Effects& effects);
// The light of a lobe cos^E about an axis, by its map; its bands are (E+1)/(E+2) and E/(E+3). Of the mirror E is
// infinite, of the diffuse part kDiffusePart. Where the program is `shaded`, it is less what is lost.
std::string lobe_light(bool shaded, double exponent, const std::string& map, const std::string& axis);
constexpr double kDiffusePart = 0;
// True if a page has room for the texture of occlusion too.
inline bool is_shaded(const Effects& effects, bool on_page) {
  return on_page && effects.background == Background::kEnvironment && effects.lobes.size() < kMostLobesOverShade;
}

// The functions of a page: of a ground on which the environment may lie, and of what the mesh occludes.
std::string page_functions(const Effects& effects, bool on_page);

// The samplers and uniforms of the G-buffer, the weights, the maps and the lights.
std::string uniforms(const Effects& effects);

// Statements that find the column of a point's weights in its row, from c = n.wo.
std::string row_of_view(const Effects& effects);

// brdf's fresnel_dielectric() with the refracted cosine g/n written in c: r_s = (c-g)/(c+g), r_p = (n^2 c-g)/(n^2 c+g).
std::string fresnel_function();

// True if gloss meets single lights, whose reflection then depends on the angle at which they are seen.
bool lit_gloss(const Effects& effects);

// The light of a disc in a lobe, by the chord from the mirror direction to its middle; and the part of a disc above the
// horizon, by the elevation of its middle relative to its radius: irradiance and part.
std::string disc_functions(std::size_t lobes);

// The start of a loop over lamps that are discs: l, disc, and `seen`, the cosine as the coat lets it in and the part of
// the disc above the horizon. `index2` is the square of the coat's index.
std::string disc_loop(const Effects& effects, const std::string& index2);

// The Fresnel reflectance of gloss toward a disc, or "1.0".
std::string disc_fresnel(const Effects& effects);

// Products of two colors are summed channel by channel or, for the operator, each channel of one with each of the
// other: the type of such a sum, one product, and the color of the sum, for which the program needs
// reflection_function().
const char* sum_type(const Effects& effects);
std::string product(const Effects& effects, const std::string& a, const std::string& b);
std::string color_of(const Effects& effects, const std::string& products);
std::string reflection_function(const color::ReflectionOperator& op);

// The start of main(): at points beside the mesh the program does what `beside` says and returns; of others it finds n,
// c = n.wo, r, and where the weights are. `more` stands before both.
std::string start_of_main(const Effects& effects, bool on_page, const std::string& more, const std::string& beside);

// The frame of the tilted normals of a brushed surface; nothing without the effect.
std::string tilt_frame(const Effects& effects);
// Adds to `sum` a function of the mirror direction: about the normal, or averaged over the tilted normals.
std::string over_tilts(const Effects& effects, const std::string& sum, const std::string& function,
                       const std::string& more);

// Statements that find what a ray shows that meets nothing: `shown`, and `sent`, the light of the ground from a white
// matt mesh, to which paints send their reflectance of it.
std::string background_colors(const Effects& effects, bool projected_ground);

}  // namespace goniochrome::render
