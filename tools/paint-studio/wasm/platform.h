// The replacements for files and threads in WebAssembly.
#pragma once

#include <map>
#include <string>

namespace goniochrome::studio {

// All that was written to an OutputFile since it was cleared last.
std::string& written_text();

// The files that can be read, by their names. The parts of a ZIP archive stand beside it, unpacked: ARCHIVE/PART.
std::map<std::string, std::string>& given_files();

// Memory for the events of an XML text, which the page writes there.
std::string& event_text();

}  // namespace goniochrome::studio
