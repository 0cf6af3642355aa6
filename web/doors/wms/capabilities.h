// web/doors/wms/capabilities.h -- what the Web Map Service says of itself (OGC 06-042, annex A.1,
// and OGC 01-068r3, annex A.1, for clients of 1.1.1).
//
// The layers stand in three ranks: domains, their moments, and the products of a moment, which
// alone can be asked for. These name the instants of their grids, since QGIS does not take them
// from the rank above.
//
// Threads   Pure functions; they may open grids.
#pragma once

#include <string>

#include "web/data/pictures/map_pictures.h"
#include "web/http/request.h"

namespace stormcellar::web {

// At /wms/DOMAIN of this domain alone, at /wms of all.
// Errors   A moment whose newest grid cannot be opened is left out.
[[nodiscard]] std::string wms_capabilities(const Request& request, MapPictures& pictures);

}  // namespace stormcellar::web
