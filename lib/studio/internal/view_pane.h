// A traced view beside a page: the picture of every paint on it. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "paint/paint.h"
#include "render/light_transport.h"
#include "studio/internal/json_reader.h"

namespace goniochrome::studio {

class ViewPane {
 public:
  // `bytes` are those of render::packed_view(). Of the request it reads parts[] of name and material, mirrors (whether
  // the finishes of render::trim_of(), which parts wear that nobody paints, mirror) and operator[27]. Error: bytes or
  // members that are no view.
  static Result<ViewPane> make(std::string_view bytes, JsonReader& request);

  int width() const { return full_->picture.width; }
  int height() const { return full_->picture.height; }

  // Fills picture() with the radiance of the view in a paint, `fit` its lobes, gloss as it holds at `gloss_deg`; or
  // with that of fewer pixels where `small`. Answers width, height, scaled, bounced_de00_p95, trace_again and
  // coat_changed, as render-osmesa reports them. Error: a paint that the light of this view cannot show.
  Result<Json> show(const paint::Paint& paint, const paint::LobeFit& fit, double gloss_deg, bool small);
  // R G B A, row by row from the top; what show() filled last.
  const std::vector<float>& picture() const { return (is_small_ ? small_ : full_)->picture.data; }

 private:
  struct Shaded {
    render::LobeTransport light;
    std::optional<render::TransportShader> shader;
    image::Image picture;
  };

  ViewPane() = default;

  color::ReflectionOperator reflection_;
  std::vector<std::string> parts_;
  std::vector<std::optional<paint::LobeFit>> finishes_;  // of each part; nothing where it wears the design
  std::unique_ptr<Shaded> full_ = std::make_unique<Shaded>(), small_ = std::make_unique<Shaded>();  // stay in place
  std::optional<render::BounceScaler> scaler_;
  bool is_small_ = false;  // of the picture that show() filled last
};

}  // namespace goniochrome::studio
