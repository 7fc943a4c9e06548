#include "sketch/traced_light.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "render/light_transport.h"
#include "sketch/internal/traced_point.h"

namespace goniochrome::sketch {

Result<TracedLight> TracedLight::of(const image::AovFile& buffers) {
  GONIO_ASSIGN(auto read, render::transport_of(buffers));
  if (!read)
    return input_error("{}: holds no light that was traced: make it by render-osmesa --aov transport", buffers.path);
  TracedLight light;
  light.transport_ = std::make_shared<const render::LobeTransport>(*std::move(read));
  light.reflection_ = buffers.reflection;
  return light;
}

int TracedLight::width() const {
  return transport_->width;
}
int TracedLight::height() const {
  return transport_->height;
}

bool TracedLight::shows_floor(int x, int y) const {
  const auto point = sketch::point_at(*transport_, x, y);
  return point && transport_->worn.is_projected(transport_->part[*point]);
}

std::optional<std::size_t> TracedLight::point_at(int x, int y) const {
  const auto point = sketch::point_at(*transport_, x, y);
  if (point && transport_->worn.is_projected(transport_->part[*point]))
    return std::nullopt;  // its light is what it shows
  return point;
}

std::optional<std::array<color::Rgb, 3>> TracedLight::diffusers(int x, int y) const {
  const auto point = point_at(x, y);
  if (!point) return std::nullopt;
  const render::LobeTransport& t = *transport_;
  const color::Rgb light = (t.unit / kPi) * t.light(*point, render::LobeColumns::diffuse());
  std::array<color::Rgb, 3> shown;
  for (int c = 0; c < 3; ++c) {
    color::Rgb one;
    one[c] = 1;
    shown[static_cast<std::size_t>(c)] = color::reflected(reflection_, one, light);
  }
  return shown;
}

// The sum of squares is a polynomial of the cosine with several valleys at most, so that it is sought on a grid of half
// a degree and then by golden sections between its neighbors.
std::optional<double> TracedLight::aspecular_deg(int x, int y) const {
  const auto point = point_at(x, y);
  if (!point || transport_->columns.exponents.empty()) return std::nullopt;
  const render::LobeTransport& t = *transport_;
  const auto luminance = [&](std::size_t column) { return color::luminance(t.light(*point, column)); };
  const double base = luminance(render::LobeColumns::diffuse());
  if (!(base > 0)) return std::nullopt;
  std::vector<double> shares;
  for (std::size_t lobe = 0; lobe < t.columns.exponents.size(); ++lobe)
    shares.push_back(luminance(render::LobeColumns::flake(lobe)) / base);
  const auto misfit = [&](double angle_deg) {
    double sum = 0;
    const double cosine = std::max(0.0, std::cos(angle_deg * kDegree));
    for (std::size_t lobe = 0; lobe < shares.size(); ++lobe) {
      const double off = std::pow(cosine, t.columns.exponents[lobe]) - shares[lobe];
      sum += off * off;
    }
    return sum;
  };
  constexpr double kStep_deg = 0.5, kGolden = 0.6180339887498949;
  double best_deg = 0;
  for (double angle = kStep_deg; angle <= 90; angle += kStep_deg)
    if (misfit(angle) < misfit(best_deg)) best_deg = angle;
  double low = std::max(0.0, best_deg - kStep_deg), high = std::min(90.0, best_deg + kStep_deg);
  while (high - low > 1e-6) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    (misfit(a) < misfit(b) ? high : low) = misfit(a) < misfit(b) ? b : a;
  }
  return 0.5 * (low + high);
}

}  // namespace goniochrome::sketch
