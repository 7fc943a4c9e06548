#include "streamed_library.h"

#include "base/paths.h"

namespace goniochrome::tool {

Result<std::optional<StreamedLibrary>> StreamedLibrary::open(const std::string& reference, cli::Session& session) {
  const std::string file = formats::paint_reference(reference).file;
  const bool is_stream = file == "-" || (is_there(file) && !is_plain_file(file) && !is_folder(file));
  if (!is_stream) return std::optional<StreamedLibrary>();
  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(reference));
  StreamedLibrary library;
  library.prolog.take(*source);
  GONIO_ASSIGN(library.paints, all_paints(*source, session));
  return std::optional(std::move(library));
}

}  // namespace goniochrome::tool
