#include "render/engine.h"

#include <algorithm>

#include "base/text.h"
#include "render/cpu/cpu_engine.h"
#include "render/gl/gl_engine.h"
#include "render/integral/integral_engine.h"
#include "render/path/path_engine.h"

namespace goniochrome::render {

const std::vector<const EngineInfo*>& engines() {
  static const std::vector<const EngineInfo*> all = {
      &CpuEngine::kInfo,
      &GlEngine::kInfo,
      &IntegralEngine::kInfo,
      &PathEngine::kInfo,
  };
  return all;
}

std::vector<std::string> engine_choices() {
  std::vector<std::string> names = {"auto"};
  for (const EngineInfo* engine : engines()) names.emplace_back(engine->name);
  return names;
}

Result<const EngineInfo*> engine_named(const std::string& name) {
  const auto found = std::ranges::find(engines(), name, &EngineInfo::name);
  if (found != engines().end()) return *found;
  return usage_error("there is no engine \"{}\": there are {}", name, joined(engines(), ", ", &EngineInfo::name));
}

}  // namespace goniochrome::render
