// The light of a view by the lobes of a basis, for tools and other rooms: it is traced (traced_lobes()), kept in files
// (transport_parts(), transport_of()), and other paints are shown in it (TransportShader, bounce_scale()).
// goniochrome-transport(7), "TRANSPORT".
#pragma once

#include "render/path/bounce_scale.h"       // IWYU pragma: export
#include "render/path/lobe_transport.h"     // IWYU pragma: export
#include "render/path/open_transport.h"     // IWYU pragma: export
#include "render/path/packed_view.h"        // IWYU pragma: export
#include "render/path/shown_paints.h"       // IWYU pragma: export
#include "render/path/transport_file.h"     // IWYU pragma: export
#include "render/path/transport_shading.h"  // IWYU pragma: export
#include "render/path/visible_surface.h"    // IWYU pragma: export

namespace goniochrome::render {}  // namespace goniochrome::render
