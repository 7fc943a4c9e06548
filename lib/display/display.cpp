// The one place that knows OpenColorIO. Whoever links it pays for its start-up time.
#include "display/display.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "base/parallel.h"
#include "base/text.h"
#include "display/paint_view.h"

namespace goniochrome::display {

namespace ocio = OCIO_NAMESPACE;

namespace {

constexpr const char* kSrgb = "sRGB";
constexpr const char* kPaint = "Paint";
constexpr const char* kPlain = "Un-tone-mapped";
constexpr const char* kAces = "ACES SDR";
constexpr color::Rgb kBackdrop{0.18, 0.18, 0.18};
constexpr const char* kApToXyz = "UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD";

ocio::BuiltinTransformRcPtr builtin(const char* style, ocio::TransformDirection direction) {
  auto transform = ocio::BuiltinTransform::Create();
  transform->setStyle(style);
  transform->setDirection(direction);
  return transform;
}

// OpenColorIO 2.1 brings no configuration: one display with two views, from its built-in transforms.
ocio::ConfigRcPtr built_in_config() {
  auto config = ocio::Config::Create();
  config->setMajorVersion(2);
  auto scene = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_SCENE);
  scene->setName("ACES2065-1");
  config->addColorSpace(scene);
  config->setRole("aces_interchange", "ACES2065-1");
  config->setRole(ocio::ROLE_DEFAULT, "ACES2065-1");
  auto display = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_DISPLAY);
  display->setName(kSrgb);
  display->setTransform(builtin("DISPLAY - CIE-XYZ-D65_to_sRGB", ocio::TRANSFORM_DIR_FORWARD),
                        ocio::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(display);
  const auto add_view = [&](const char* name, const char* style) {
    auto view = ocio::ViewTransform::Create(ocio::REFERENCE_SPACE_SCENE);
    view->setName(name);
    view->setTransform(builtin(style, ocio::TRANSFORM_DIR_FORWARD), ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE);
    config->addViewTransform(view);
    config->addDisplayView(kSrgb, name, name, kSrgb, "", "", "");
  };
  add_view(kPlain, kApToXyz);
  add_view(kAces, "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0");
  config->setDefaultViewTransformName(kPlain);
  return config;
}

// Working space -> CIE XYZ (D65) -> ACES2065-1, the space that every configuration of version 2 can be entered by ->
// display.
ocio::ConstCPUProcessorRcPtr processor(const ocio::ConstConfigRcPtr& config, const char* display, const char* view,
                                       ocio::TransformDirection direction) {
  auto matrix = ocio::MatrixTransform::Create();
  const color::Xyz r = color::xyz_d65_from_rgb({1, 0, 0}), g = color::xyz_d65_from_rgb({0, 1, 0}),
                   b = color::xyz_d65_from_rgb({0, 0, 1});
  const double to_xyz[16] = {r.X, g.X, b.X, 0, r.Y, g.Y, b.Y, 0, r.Z, g.Z, b.Z, 0, 0, 0, 0, 1};
  matrix->setMatrix(to_xyz);
  auto to_display = ocio::DisplayViewTransform::Create();
  to_display->setSrc("aces_interchange");
  to_display->setDisplay(display);
  to_display->setView(view);
  auto group = ocio::GroupTransform::Create();
  group->appendTransform(matrix);
  group->appendTransform(builtin(kApToXyz, ocio::TRANSFORM_DIR_INVERSE));
  group->appendTransform(to_display);
  return config->getProcessor(group, direction)->getDefaultCPUProcessor();
}

struct Choice {
  std::string display, view;
};

std::string full_name(const Choice& choice) {
  return choice.display + " / " + choice.view;
}

std::vector<Choice> choices(const ocio::ConstConfigRcPtr& config) {
  std::vector<Choice> all;
  const char* first = config->getDefaultDisplay();
  for (int v = 0; v < config->getNumViews(first); ++v) all.push_back({first, config->getView(first, v)});
  for (int d = 0; d < config->getNumDisplays(); ++d) {
    const std::string display = config->getDisplay(d);
    if (display == first) continue;
    for (int v = 0; v < config->getNumViews(display.c_str()); ++v) {
      all.push_back({display, config->getView(display.c_str(), v)});
    }
  }
  return all;
}

Result<Choice> find_view(const std::vector<Choice>& all, const std::string& wanted) {
  if (wanted.empty()) return all.front();
  std::string known;
  for (const Choice& choice : all) {
    const std::string full = choice.display + "/" + choice.view;
    if (lower(wanted) == lower(full) || lower(wanted) == lower(full_name(choice))) return choice;
    if (lower(wanted) == lower(choice.view)) return choice;  // the default display's come first
    known += (known.empty() ? "\"" : ", \"") + (choice.display == all.front().display ? choice.view : full) + "\"";
  }
  return usage_error("there is no view \"{}\": there are {}", wanted, known);
}

}  // namespace

namespace {

// The signals of a display, by the words that configurations of OpenColorIO name it with.
std::optional<image::SignalCode> signal_of(const std::string& color_space) {
  const std::string name = lower(color_space);
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  const bool pq = has("pq") || has("2084"), hlg = has("hlg"), video = has("1886");
  if (has("p3"))
    return pq                  ? std::optional(image::SignalCode{12, 16})
           : has("display p3") ? std::optional(image::SignalCode{12, 13})
                               : std::nullopt;
  if (has("2020") || has("2100")) {
    if (pq || hlg) return image::SignalCode{9, pq ? 16 : 18};
    return video ? std::optional(image::SignalCode{9, 14}) : std::nullopt;
  }
  if (has("srgb")) return image::SignalCode{};
  if (video && has("709")) return image::SignalCode{1, 1};
  return std::nullopt;
}

}  // namespace

struct Display::State {
  std::string name;
  std::optional<image::SignalCode> signal = image::SignalCode{};
  ocio::ConstConfigRcPtr config;           // none: the view "Paint", which needs no OpenColorIO
  ocio::ConstCPUProcessorRcPtr processor;  // of that
  Choice choice;
};

Display::Display(std::unique_ptr<State> state) : state_(std::move(state)) {}
Display::Display(Display&&) noexcept = default;
Display::~Display() = default;

const std::string& Display::name() const {
  return state_->name;
}

Result<Display> Display::make(const std::string& view) {
  const char* path = std::getenv("OCIO");
  const bool own = path != nullptr && *path != '\0';
  const std::string wanted = lower(view);
  const bool is_paint = wanted.empty() || wanted == lower(kPaint) ||
                        wanted == lower(std::string(kSrgb) + "/" + kPaint) ||
                        wanted == lower(full_name({kSrgb, kPaint}));
  if (!own && is_paint) {
    auto state = std::make_unique<State>();
    state->name = full_name({kSrgb, kPaint});
    return Display(std::move(state));
  }
  try {
    ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
    const ocio::ConstConfigRcPtr config = own ? ocio::Config::CreateFromFile(path) : built_in_config();
    std::vector<Choice> all = choices(config);
    if (!own) all.insert(all.begin(), {kSrgb, kPaint});
    if (all.empty()) return input_error("{}: the OpenColorIO configuration of $OCIO has no displays", path);
    GONIO_ASSIGN(const Choice choice, find_view(all, view));
    auto state = std::make_unique<State>();
    state->name = full_name(choice);
    const std::string space = config->getDisplayViewColorSpaceName(choice.display.c_str(), choice.view.c_str());
    state->signal = signal_of(space.empty() || space == "<USE_DISPLAY_NAME>" ? choice.display : space);
    state->processor = processor(config, choice.display.c_str(), choice.view.c_str(), ocio::TRANSFORM_DIR_FORWARD);
    state->config = config, state->choice = choice;
    return Display(std::move(state));
  } catch (const ocio::Exception& refused) {
    if (!own) return Error{ErrorKind::kBug, fmt::format("OpenColorIO: {}", refused.what())};
    return input_error(
        "{}: OpenColorIO: {}: $OCIO must name a configuration of version 2 with an aces_interchange role; unset it for "
        "the built-in views",
        path, refused.what());
  }
}

namespace {

// The color in front of the backdrop, in the working space.
color::Rgb over_backdrop(const float* rgba, double gain) {
  return gain * color::Rgb{rgba[0], rgba[1], rgba[2]} + (1 - rgba[3]) * kBackdrop;
}

// The view "Paint" of it, linear Rec.709.
color::Rgb painted(const float* rgba, double gain) {
  return paint_view(color::rec709_from_rec2020(over_backdrop(rgba, gain)));
}

// The inverse of srgb_signal().
double srgb_light(double signal) {
  return signal <= 12.92 * 0.0031308 ? signal / 12.92 : std::pow((signal + 0.055) / 1.055, 2.4);
}

// The codes of an 8-bit sRGB display: code k is shown from the light on whose signal is (k - 1/2)/255.
class SrgbCodes {
 public:
  SrgbCodes() {
    for (std::size_t k = 0; k < 255; ++k) ends_[k] = srgb_light((static_cast<double>(k) + 0.5) / 255);
    ends_[255] = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0, k = 0; i < kSteps; ++i) {
      while (ends_[k] <= static_cast<double>(i) / kSteps) ++k;
      first_[i] = static_cast<std::uint8_t>(k);
    }
  }

  // Light below 0, or a NaN, counts as 0.
  std::uint8_t code(double light) const {
    if (!(light > 0)) return 0;
    if (light >= 1) return 255;
    std::size_t k = first_[static_cast<std::size_t>(light * kSteps)];
    while (ends_[k] <= light) ++k;
    return static_cast<std::uint8_t>(k);
  }

 private:
  static constexpr std::size_t kSteps = 4096;
  double ends_[256];
  std::uint8_t first_[kSteps];  // the code of the lower end of each step
};

Result<void> check_shown(const image::Image& picture) {
  if (auto finite = image::check_finite(picture); !finite.ok())
    return input_error("the picture: {}", finite.error().message);
  return {};
}

}  // namespace

Result<void> Display::show(const image::Image& picture, double stops, image::ByteImage& shown) const {
  if (state_->processor) {
    GONIO_ASSIGN(const image::Image signals, image(picture, stops));
    image::put_bytes(signals, shown);
    shown.signal = state_->signal;
    return {};
  }
  GONIO_TRY(check_shown(picture));
  static const SrgbCodes codes;
  const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  const double gain = std::exp2(stops);
  shown.width = picture.width, shown.height = picture.height;
  shown.rgb.resize(3 * pixels), shown.signal = state_->signal;
  parallel_for(pixels, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const color::Rgb c = painted(&picture.data[4 * i], gain);
      for (int channel = 0; channel < 3; ++channel)
        shown.rgb[3 * i + static_cast<std::size_t>(channel)] = codes.code(c[channel]);
    }
  });
  return {};
}

Result<image::Image> Display::image(const image::Image& picture, double stops) const {
  GONIO_TRY(check_shown(picture));
  image::Image shown = image::even_image(picture.width, picture.height, 3, {"R", "G", "B"});
  const std::size_t pixels = shown.data.size() / 3;
  const double gain = std::exp2(stops);
  try {
    parallel_for(pixels, 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const float* p = &picture.data[4 * i];
        const color::Rgb c = state_->processor ? over_backdrop(p, gain) : painted(p, gain);
        for (int channel = 0; channel < 3; ++channel)
          shown.data[3 * i + channel] = static_cast<float>(state_->processor ? c[channel] : srgb_signal(c[channel]));
      }
      if (!state_->processor) return;
      ocio::PackedImageDesc run(&shown.data[3 * begin], static_cast<long>(end - begin), 1, 3);
      state_->processor->apply(run);
      for (std::size_t i = 3 * begin; i < 3 * end; ++i) shown.data[i] = std::clamp(shown.data[i], 0.0F, 1.0F);
    });
  } catch (const ocio::Exception& refused) {
    return input_error("OpenColorIO: {}", refused.what());
  }
  return shown;
}

Result<void> Display::undo(image::Image& signals) const {
  const std::size_t pixels = static_cast<std::size_t>(signals.width) * static_cast<std::size_t>(signals.height);
  if (!state_->processor) {
    parallel_for(pixels, 1 << 12, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        float* p = &signals.data[3 * i];
        const color::Rgb light =
            color::rec2020_from_rec709(paint_view_undone({srgb_light(p[0]), srgb_light(p[1]), srgb_light(p[2])}));
        for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(light[c]);
      }
    });
    return {};
  }
  try {
    const auto inverse = processor(state_->config, state_->choice.display.c_str(), state_->choice.view.c_str(),
                                   ocio::TRANSFORM_DIR_INVERSE);
    parallel_for(pixels, 1 << 12, [&](std::size_t begin, std::size_t end) {
      ocio::PackedImageDesc run(&signals.data[3 * begin], static_cast<long>(end - begin), 1, 3);
      inverse->apply(run);
    });
  } catch (const ocio::Exception& refused) {
    return input_error("the view \"{}\" cannot be undone: OpenColorIO: {}", state_->name, refused.what());
  }
  return {};
}

}  // namespace goniochrome::display
