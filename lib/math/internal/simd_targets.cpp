// The functions of Highway that its dynamic dispatch and our tests call, so that no program links libhwy.
//
// When libhwy is loaded, it measures the resolution of its timer for 4 ms of processor time, which was half of the cost
// of starting a tool that has an instruction set to choose. Nothing else of that library is in use: the vector types
// and the dispatch are templates and macros of its headers. Where the processor is no x86, this file is empty and
// libhwy is linked; lib/CMakeLists.txt decides.
#if defined(__x86_64__)
#include <hwy/targets.h>

#include <atomic>
#include <cstdint>

namespace goniochrome::math {
namespace {

// The instruction sets that Highway 1.0 asks for, without those of which every processor with AVX2 has all (LZCNT,
// F16C). HWY_AVX3_DL is left out, because Highway compiles nothing for it unless it is asked to.
std::int64_t targets_of_this_processor() {
  __builtin_cpu_init();
  std::int64_t targets = HWY_EMU128 | HWY_SCALAR;
  const bool ssse3 = __builtin_cpu_supports("ssse3");
  const bool sse4 = ssse3 && __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
                    __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes");
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool avx3 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd");
  if (ssse3) targets |= HWY_SSSE3;
  if (sse4) targets |= HWY_SSE4;
  if (avx2) targets |= HWY_AVX2;
  if (avx3) targets |= HWY_AVX3;
  return targets;
}

std::atomic<std::int64_t> chosen_by_a_test = 0;

}  // namespace
}  // namespace goniochrome::math

namespace hwy {

std::int64_t SupportedTargets() {
  static const std::int64_t targets = goniochrome::math::targets_of_this_processor();
  const std::int64_t chosen = goniochrome::math::chosen_by_a_test;
  return chosen ? chosen : targets;
}

void SetSupportedTargetsForTest(std::int64_t targets) {
  goniochrome::math::chosen_by_a_test = targets;
  GetChosenTarget().DeInit();
}

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

}  // namespace hwy

#endif
