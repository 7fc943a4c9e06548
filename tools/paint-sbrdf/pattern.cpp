#include "pattern.h"

#include <algorithm>

#include "base/angles.h"
#include "base/text.h"

namespace goniochrome::tool {

Result<Mask> Mask::read(const std::string& path, bool alpha, bool invert) {
  GONIO_ASSIGN(const image::ImagePart part, image::read_image(path));
  const image::Image& from = part.image;
  const auto named = std::ranges::find(from.channel_names, "A");
  const bool has_alpha = alpha && named != from.channel_names.end();
  const int colors = from.channels < 3 ? 1 : 3;
  Mask mask;
  mask.gray_ = {from.width, from.height, 1, {}, {"Y"}};
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x) {
      const float* pixel = from.pixel(x, y);
      float value = 0;
      for (int c = 0; c < colors; ++c) value += pixel[c] / static_cast<float>(colors);
      if (has_alpha) value = pixel[named - from.channel_names.begin()];
      if (!std::isfinite(value))
        return input_error("{}: pixel ({},{}) is {}: a mask holds numbers from 0 to 1", path, x, y, value);
      value = std::clamp(value, 0.0F, 1.0F);
      mask.gray_.data.push_back(invert ? 1 - value : value);
    }
  }
  return mask;
}

Result<Amount> Amount::parse(const std::string& option, const std::string& text) {
  Amount amount;
  if (text.empty()) return amount;
  if (const auto number = parse_number(text)) {
    if (*number < 0 || *number > 1)
      return usage_error("--{} is {}: give a number from 0 to 1, or a picture whose gray says how much where", option,
                         shortest(*number));
    amount.value_ = *number;
    return amount;
  }
  GONIO_ASSIGN(Mask mask, Mask::read(text, false, false));
  amount.mask_ = std::make_shared<Mask>(std::move(mask));
  return amount;
}

double Amount::at(double u, double v) const {
  if (!mask_) return value_;
  double sum = 0;
  mask_->at(u, v, true, [&](double value, double share) { sum += share * value; });
  return sum;
}

namespace {

Result<void> check_stripe(const std::vector<double>& numbers, std::size_t surfaces) {
  if (numbers.size() % 2 != 0)
    return usage_error("--stripe has {} numbers: give where each stripe begins and ends, as in --stripe 0.4,0.6",
                       numbers.size());
  if (numbers.size() / 2 + 1 != surfaces)
    return usage_error(
        "--stripe tells of {} stripes, and there are {} surfaces: give one surface for the ground, and "
        "one for each stripe",
        numbers.size() / 2, surfaces);
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    if (numbers[i] >= numbers[i + 1])
      return usage_error("--stripe goes from {} to {}: give the lower number first", shortest(numbers[i]),
                         shortest(numbers[i + 1]));
  return {};
}

Result<void> check_mix(const std::vector<double>& shares, std::size_t surfaces) {
  if (shares.size() + 1 != surfaces)
    return usage_error("--mix has {} shares, and there are {} surfaces: give the share of each surface but the first",
                       shares.size(), surfaces);
  double sum = 0;
  for (const double share : shares) sum += share;
  if (sum > 1)
    return usage_error("--mix adds up to {}: the shares of all surfaces but the first are 1 at most", shortest(sum));
  return {};
}

}  // namespace

Result<Pattern> Pattern::create(const Options& o, std::size_t surfaces) {
  Pattern p;
  p.surfaces_ = surfaces;
  std::vector<std::string> given;
  const auto take = [&](bool is_given, const char* name, Kind kind) {
    if (is_given) given.emplace_back(name), p.kind_ = kind;
  };
  take(!o.stripe.empty(), "--stripe", Kind::kStripe);
  take(o.gradient, "--gradient", Kind::kGradient);
  take(!o.mask.empty(), "--mask", Kind::kMask);
  take(!o.decal.empty(), "--decal", Kind::kDecal);
  take(o.mosaic > 0, "--mosaic", Kind::kMosaic);
  take(!o.mix.empty(), "--mix", Kind::kMix);
  if (given.size() > 1)
    return usage_error("{} exclude each other: make one map, and then the next one of it", joined(given, " and "));
  if (given.empty() && surfaces > 1)
    return usage_error(
        "there are {} surfaces: say where each lies, by --stripe, --gradient, --mask, --decal, --mosaic "
        "or --mix",
        surfaces);
  if (!given.empty() && surfaces < 2)
    return usage_error("{} lays out two surfaces or more: name another one", given.front());
  if (p.kind_ == Kind::kStripe) GONIO_TRY(check_stripe(p.numbers_ = o.stripe, surfaces));
  if (p.kind_ == Kind::kMix) GONIO_TRY(check_mix(p.numbers_ = o.mix, surfaces));
  if (p.kind_ == Kind::kDecal && surfaces != 2)
    return usage_error("--decal takes two surfaces, the ground and the decal, and there are {}", surfaces);
  if (!o.place.empty() && (p.kind_ != Kind::kDecal || o.place.size() != 3 || o.place[2] <= 0))
    return usage_error("--place is for --decal: give its middle and its width, as in --place 0.5,0.5,0.8");
  if (!o.place.empty()) p.center_x_ = o.place[0], p.center_y_ = o.place[1], p.wide_ = o.place[2];
  if (o.invert && p.kind_ != Kind::kDecal && p.kind_ != Kind::kMask)
    return usage_error("--invert is for --mask and --decal");
  p.columns_ = o.mosaic;
  p.cosine_ = std::cos(o.angle_deg * kDegree), p.sine_ = std::sin(o.angle_deg * kDegree);
  if (p.kind_ == Kind::kMask || p.kind_ == Kind::kDecal) {
    GONIO_ASSIGN(Mask mask, Mask::read(o.mask + o.decal, p.kind_ == Kind::kDecal, o.invert));
    p.mask_ = std::make_shared<Mask>(std::move(mask));
  }
  return p;
}

std::pair<int, int> Pattern::size() const {
  return kind_ == Kind::kMask ? std::pair(mask_->width(), mask_->height()) : std::pair(0, 0);
}

std::string Pattern::told() const {
  switch (kind_) {
    case Kind::kStripe:
      return fmt::format("stripes: {} on the first surface", surfaces_ - 1);
    case Kind::kGradient:
      return "gradient: from the first surface to the last";
    case Kind::kMask:
      return fmt::format("mask: {} x {} pixels, black is the first of {} surfaces and white the last", mask_->width(),
                         mask_->height(), surfaces_);
    case Kind::kDecal:
      return fmt::format("decal: {} x {} pixels, where it is white is the second surface", mask_->width(),
                         mask_->height());
    case Kind::kMosaic:
      return fmt::format("mosaic: {} surfaces in {} columns", surfaces_, columns_);
    case Kind::kMix:
      return fmt::format("mixture: of {} surfaces, the same everywhere", surfaces_);
    default:
      return "one surface";
  }
}

// The value k/(N-1) is surface k, and a value between two is a mixture of both; a value that the steps of 8 bits tell
// from such a one is taken as that.
void Pattern::add_value(double value, double share, std::vector<double>& shares) const {
  const double last = static_cast<double>(surfaces_ - 1), at = std::clamp(value, 0.0, 1.0) * last;
  const double nearest = std::round(at);
  if (std::abs(at - nearest) <= 0.51 / 255 * last) {
    shares[static_cast<std::size_t>(nearest)] += share;
    return;
  }
  const auto lower = static_cast<std::size_t>(at);
  shares[lower] += share * (1 - (at - std::floor(at)));
  shares[lower + 1] += share * (at - std::floor(at));
}

void Pattern::add(double u, double v, double aspect, double share, std::vector<double>& shares) const {
  const double size = std::abs(cosine_) + std::abs(sine_);
  switch (kind_) {
    case Kind::kStripe: {
      const double across = 0.5 + (cosine_ * (v - 0.5) - sine_ * (u - 0.5)) / size;
      std::size_t surface = 0;
      for (std::size_t i = 0; i < numbers_.size(); i += 2)
        if (across >= numbers_[i] && across < numbers_[i + 1]) surface = i / 2 + 1;
      shares[surface] += share;
      return;
    }
    case Kind::kMask:
      mask_->at(u, v, false, [&](double value, double part) { add_value(value, share * part, shares); });
      return;
    case Kind::kDecal: {
      // Its pixels are squares on the map, whose texels are squares.
      const double x = aspect * (u - center_x_), y = v - center_y_, wide = aspect * wide_;
      const double high = wide * mask_->height() / mask_->width();
      const double s = 0.5 + (cosine_ * x + sine_ * y) / wide, t = 0.5 + (cosine_ * y - sine_ * x) / high;
      if (s < 0 || s >= 1 || t < 0 || t >= 1) {
        shares[0] += share;
        return;
      }
      mask_->at(s, t, true, [&](double value, double part) { add_value(value, share * part, shares); });
      return;
    }
    default:
      return;
  }
}

Shares Pattern::shares(int column, int row, int width, int height) const {
  std::vector<double> shares(surfaces_, 0.0);
  const double u = (column + 0.5) / width, v = 1 - (row + 0.5) / height;
  switch (kind_) {
    case Kind::kPlain:
      shares[0] = 1;
      break;
    case Kind::kMix: {
      shares[0] = 1;
      for (std::size_t i = 0; i < numbers_.size(); ++i) shares[i + 1] = numbers_[i], shares[0] -= numbers_[i];
      shares[0] = std::max(shares[0], 0.0);
      break;
    }
    case Kind::kGradient: {
      const double size = std::abs(cosine_) + std::abs(sine_);
      add_value(0.5 + (cosine_ * (u - 0.5) + sine_ * (v - 0.5)) / size, 1, shares);
      break;
    }
    case Kind::kMosaic: {
      const int rows = (static_cast<int>(surfaces_) + columns_ - 1) / columns_;
      const int cell = std::min(static_cast<int>((1 - v) * rows), rows - 1) * columns_ +
                       std::min(static_cast<int>(u * columns_), columns_ - 1);
      shares[std::min(static_cast<std::size_t>(cell), surfaces_ - 1)] = 1;
      break;
    }
    case Kind::kMask:
      if (mask_->width() < width || mask_->height() < height) {
        mask_->at(u, v, true, [&](double value, double part) { add_value(value, part, shares); });
        break;
      }
      [[fallthrough]];
    default: {  // the mean over the texel
      constexpr int kSide = 8;
      for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j)
          add((column + (i + 0.5) / kSide) / width, 1 - (row + (j + 0.5) / kSide) / height,
              static_cast<double>(width) / height, 1.0 / (kSide * kSide), shares);
    }
  }
  Shares result;
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (shares[i] > 1e-9) result.emplace_back(i, shares[i]);
  return result;
}

}  // namespace goniochrome::tool
