// Pictures of picked paints.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "paint/paint.h"
#include "tool.h"

namespace goniochrome::tool {

// Draws one paint after another on the mesh and under the light of the options.
class PaintDrawing {
 public:
  // `session` hears what the file of the mesh says that is not understood.
  static Result<PaintDrawing> make(const Options& options, cli::Session& session);
  PaintDrawing(PaintDrawing&&) noexcept;
  ~PaintDrawing();

  // A PNG of the paint.
  Result<std::string> png(const paint::Paint& paint);

  // "on car.obj under studio.env.exr"
  std::string described() const;

 private:
  struct State;
  explicit PaintDrawing(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace goniochrome::tool
