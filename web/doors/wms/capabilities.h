// web/doors/wms/capabilities.h -- writes the capabilities of the Web Map Service (OGC 06-042, annex
// A.1, and OGC 01-068r3, annex A.1, for clients of 1.1.1).
//
// The layers form three levels: domains, their moments, and the products of a moment. Only products
// can be requested. Each product lists the instants of its grids, because QGIS does not inherit
// these from the level above.
//
// Threads   Pure functions; they may open grids.
#pragma once

#include <string>

#include "web/data/pictures/map_pictures.h"
#include "web/http/request.h"

namespace stormcellar::web {

// Returns the document. At /wms/DOMAIN it has only this domain, at /wms all domains.
// Errors   A moment whose newest grid cannot be opened is left out.
[[nodiscard]] std::string wms_capabilities(const Request& request, MapPictures& pictures);

}  // namespace stormcellar::web
