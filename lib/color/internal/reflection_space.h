// Reflection operators in other primaries than those of the working space.
#pragma once

#include "color/reflection.h"

namespace goniochrome::color {

// The operator on values of the space of these primaries that does what `op` does on working-space values: the other
// way of in_working_space(). Error: as that has them.
Result<ReflectionOperator> in_primaries(const ReflectionOperator& op, const Primaries& target);

}  // namespace goniochrome::color
