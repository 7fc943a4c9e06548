#include "render/gl/gl_engine.h"

#include <algorithm>
#include <cmath>

#include "render/gl/disc_texture.h"
#include "render/gl/exact_lookups.h"
#include "render/gl/shader.h"
#include "render/gl/shader_parts.h"
#include "render/internal/tilt_table.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

const EngineInfo GlEngine::kInfo = {
    .name = "gl",
    .sentence = "shades by prefiltered maps in OpenGL, where each map is a cube texture",
    .is_planned = true,
    .needs_opengl = true,
    .needs_mesh = true,
    .make = [](Sight& sight) -> std::unique_ptr<Engine> { return std::make_unique<GlEngine>(sight.gl()); }};

Result<void> GlEngine::can_shade(const Scene&) const {
  if (gl_ != nullptr) return {};
  return usage_error("the engine gl draws the mesh: a G-buffer that is given is shaded by cpu");
}

// Float texels: a half would have to be rounded first, since llvmpipe truncates, and is no faster to fetch.
void GlEngine::upload(const envmap::CubeMap& map, const std::string& sampler) {
  GLuint texture = 0;
  gl_->GenTextures(1, &texture);
  gl_->BindTexture(GL_TEXTURE_CUBE_MAP, texture);
  for (int face = 0; face < 6; ++face) {
    const GLenum target = GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face);
    gl_->TexImage2D(target, 0, GL_RGB32F, map.size, map.size, 0, GL_RGB, GL_FLOAT, map.at(face, 0, 0));
  }
  const GLint filter = gl_->on_gpu() ? GL_NEAREST : GL_LINEAR;  // with_exact_lookups() interpolates
  gl_->TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, filter);
  gl_->TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, filter);
  cubes_.emplace_back(sampler, texture);
}

Result<void> GlEngine::load(const Scene& scene, const Effects& effects) {
  GONIO_ASSIGN(const SceneMaps maps, scene_maps(scene, effects));
  if (!tilt_exponents(scene, effects).empty())
    return usage_error(
        "the engine gl draws no tilted lobes, which stand for color maps and rough coats: take the engine cpu, or "
        "leave "
        "them out by --effects auto,-travel,-satin");
  std::string text = shading_fragment_shader(effects, scene.reflection);
  if (gl_->on_gpu()) text = with_exact_lookups(text);
  if (text != text_) {
    if (program_ != 0) gl_->DeleteProgram(program_);
    GONIO_ASSIGN(program_, gl_->program(shading_vertex_shader(), text));
    text_ = text;
  }
  if (no_vertices_ == 0) gl_->GenVertexArrays(1, &no_vertices_);
  gl_->BlendFunc(GL_ONE, GL_ONE);
  for (const auto& [sampler, texture] : cubes_) gl_->DeleteTextures(1, &texture);
  cubes_.clear();
  if (maps.diffuse.size > 0) upload(*maps.diffuse.maps[0], "diffuse");
  if (maps.diffuse.maps.size() > 1) upload(*maps.diffuse.maps[1], "coat_diffuse");
  for (const MapClass& lobes : maps.lobes) {
    for (std::size_t i = 0; i < lobes.slots.size(); ++i)
      upload(*at_size(lobes.maps[i], lobes.size), fmt::format("lobe_{}", lobes.slots[i] - 1));
  }
  if (maps.mirror.size > 0) upload(*maps.mirror.maps[0], "mirror");
  effects_ = effects;
  const int units = gl_->integer(GL_MAX_TEXTURE_IMAGE_UNITS);
  const std::size_t needed = 2 + (effects.anisotropy ? 1 : 0) + (effects.discs() ? 1 : 0) + cubes_.size();
  if (static_cast<int>(needed) > units) {
    return input_error(
        "the paints use {} lobes, but OpenGL has only {} texture units: fit the paints to one common basis, or take "
        "--engine cpu",
        effects.lobes.size(), units);
  }
  load_paints(scene);
  return gl_->status("uploading the scene");
}

void GlEngine::set_lamps() {
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    gl_->set(program_, fmt::format("light_direction[{}]", i), lights_[i].direction);
    gl_->set(program_, fmt::format("light_white[{}]", i), lights_[i].white);
    if (discs_ != 0) gl_->set(program_, fmt::format("light_disc[{}]", i), disc_uniform(lights_[i]));
  }
}

void GlEngine::load_paints(const Scene& scene) {
  const WeightTable table = weight_table(scene, effects_);
  gl_->DeleteTextures(1, &weights_);
  std::vector<float> weights;  // part by part
  for (const int row : table.rows) {
    const float* of_row = table.at(row, 0, 0);
    weights.insert(weights.end(), of_row, of_row + table.row_floats());
  }
  weights_ = gl_->float_texture(2 * table.slots * table.segments, static_cast<int>(table.rows.size()), weights.data());
  gl_->DeleteTextures(1, &tilts_);
  tilts_ = 0;
  if (effects_.anisotropy) {
    const std::vector<float> texels = tilt_texels(tilts_of(scene, effects_));
    const auto rows = static_cast<int>(scene.paints.size());
    tilts_ = gl_->float_texture(static_cast<int>(texels.size() / 4) / rows, rows, texels.data());
  }
  lights_ = single_lights(scene, effects_);
  gl_->DeleteTextures(1, &discs_);
  discs_ = 0;
  if (effects_.discs() && !lights_.empty()) {
    const FloatTexture discs = disc_texture(lights_, effects_);
    discs_ = gl_->float_texture(discs.columns, discs.rows, discs.rgba.data());
  }
  background_color_ = scene.background_color;
}

Result<void> GlEngine::resize(int width, int height) {
  if (width == width_ && height == height_) return {};
  gl_->float_target(width, height, texture_, target_);
  width_ = width, height_ = height;
  return gl_->status("making the framebuffer");
}

Result<void> GlEngine::shade(Sight& sight, int sample, float gain, bool add, image::Image&) {
  const std::shared_ptr<const Gbuffer> seen = sight.gbuffer(sample);
  GONIO_TRY(resize(seen->width, seen->height));
  gl_->DeleteTextures(1, &gbuffer_);
  gbuffer_ = gl_->float_texture(seen->width, seen->height, seen->data.data());
  gain_ = gain;
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_);
  gl_->Viewport(0, 0, width_, height_);
  if (add) gl_->Enable(GL_BLEND);
  gl_->UseProgram(program_);
  gl_->set_rays(program_, seen->rays);
  GLint unit = 0;
  const auto bind = [&](const std::string& sampler, GLenum kind, GLuint texture) {
    gl_->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl_->BindTexture(kind, texture);
    gl_->Uniform1i(gl_->GetUniformLocation(program_, sampler.c_str()), unit++);
  };
  bind("gbuffer", GL_TEXTURE_2D, gbuffer_);
  bind("weights", GL_TEXTURE_2D, weights_);
  if (effects_.anisotropy) bind("tilts", GL_TEXTURE_2D, tilts_);
  if (discs_ != 0) bind("discs", GL_TEXTURE_2D, discs_);
  for (const auto& [sampler, texture] : cubes_) bind(sampler, GL_TEXTURE_CUBE_MAP, texture);
  gl_->ActiveTexture(GL_TEXTURE0);
  set_lamps();
  if (effects_.background == Background::kColor) gl_->set(program_, "background", background_color_);
  gl_->BindVertexArray(no_vertices_);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->Disable(GL_BLEND);
  return {};
}

void GlEngine::finish(image::Image& rgba) {
  rgba.width = width_, rgba.height = height_, rgba.channels = 4;
  rgba.data.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_);
  gl_->ReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, rgba.data.data());
  for (float& value : rgba.data) value *= gain_;
}

}  // namespace goniochrome::render
