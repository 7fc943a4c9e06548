// Reflection operators by name, as options of tools have them, and in JSON files.
// goniochrome-color(7), "COLORED LIGHT".
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "color/reflection.h"

namespace goniochrome::color {

// The name of the operator that tools take without being told.
constexpr const char* kDefaultOperator = "fitted";

// The operator that a text names: fitted, plain (or none), iso, iso709, estimated (or working, or rec2020), or the path
// of a JSON file. After a comma, a number from 0 to 1 says how much each channel takes from the others, and three
// numbers say it for red, green and blue; `shares`, if given, replaces them. Shares are set in the primaries of the
// table: those of Rec.709 for iso709 and estimated, those that a file names, else Rec.2020. Error: of usage, what the
// text may be; of input, a channel that takes nothing from the others or keeps more than 1; or of the file.
Result<ReflectionOperator> chosen_operator(const std::string& text, const std::optional<Rgb>& shares = {});

// Sentences about each of these, for those who choose among them.
std::string operator_sentences();

// The operator as the text of a JSON file, {"k": [[[..3..],[..],[..]], [..], [..]]}, by output channel and then by both
// colors. The numbers have the fewest digits that read back as the same numbers. `primaries`, if given, are stored:
// "primaries": [[x,y],[x,y],[x,y]], "white": [x,y].
std::string reflection_json(const ReflectionOperator& op, const Primaries* primaries = nullptr);

// Reads such a file, and returns the operator on working-space values. "primaries" may also be "rec709" or "rec2020";
// without them the table is for working-space values. Error: the file, and what is missing; or the row in which an
// operator is not symmetric and coherent to 1e-6.
Result<ReflectionOperator> read_reflection_operator(const std::string& path);

}  // namespace goniochrome::color
