#include "render/engine.h"

#include <algorithm>

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
  std::string known;
  for (const EngineInfo* engine : engines()) known += (known.empty() ? "" : ", ") + std::string(engine->name);
  return usage_error("there is no engine \"{}\": there are {}", name, known);
}

}  // namespace goniochrome::render
