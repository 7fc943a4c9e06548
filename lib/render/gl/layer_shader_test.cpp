#include "render/gl/layer_shader.h"

#include <gtest/gtest.h>

#include <map>

namespace goniochrome::render::layer_shader_test {
namespace {

Effects page_like_effects() {
  Effects effects;
  effects.environment = effects.mirror = effects.fresnel = effects.coat = effects.horizon = effects.reflection = true;
  effects.lobes = {{2, true, true}, {80, true, false}, {300, false, true}};
  effects.spots = 2;
  return effects;
}

// Weights of slots that neither are shifts nor have a layer would be lost from a picture.
TEST(LightLayers, EverySlotThatMeetsLightHasOneLayer) {
  const Effects effects = page_like_effects();
  const WeightTable slots = slots_of(effects);
  std::map<int, int> layers;
  for (const LightLayer& layer : light_layers(effects)) {
    ++layers[layer.slot];
    EXPECT_EQ(layer.of_lamps, layer.sampler.empty());
    EXPECT_EQ(layer.of_lamps, layer.slot >= slots.light_slot());
  }
  std::map<int, int> expected;
  for (int slot = 0; slot < slots.slots; ++slot) expected[slot] = 1;
  expected.erase(slots.shift_slot(0));
  // Slots of weights that no paint has under these effects.
  expected.erase(slots.gloss_slot(1));
  expected.erase(slots.directional_diffuse_slot(2));
  EXPECT_EQ(layers, expected);
}

TEST(LightLayers, WideLobesAloneLookBesideTheMirrorDirection) {
  for (const LightLayer& layer : light_layers(page_like_effects())) {
    const bool is_wide = layer.sampler == "lobe_0" || layer.sampler == "lobe_1";
    EXPECT_EQ(layer.shift_slot >= 0, is_wide) << layer.sampler;
    EXPECT_EQ(layer.shift_channel, layer.sampler == "lobe_1" ? 1 : 0) << layer.sampler;
  }
}

TEST(LightLayers, WithoutLampsThereAreNoneOfThem) {
  Effects effects = page_like_effects();
  effects.spots = 0;
  for (const LightLayer& layer : light_layers(effects)) EXPECT_FALSE(layer.of_lamps);
}

TEST(LightLayers, TheMostLobesOfAPageHaveRoom) {
  Effects effects = page_like_effects();
  effects.lobes.assign(9, {2, true, true});
  EXPECT_LE(light_layers(effects).size(), static_cast<std::size_t>(kMostLayers));
}

}  // namespace
}  // namespace goniochrome::render::layer_shader_test
