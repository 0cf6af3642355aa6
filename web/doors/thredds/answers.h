// web/doors/thredds/answers.h -- the catalogs of the THREDDS radar server, as XML.
//
// The format is InvCatalog 1.0. The bases of services are paths without scheme and host. So a
// client that reached the server by https goes on with https.
//
// Threads   Pure functions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "web/doors/thredds/collection.h"

namespace stormcellar::web {

using ThreddsCollections = std::vector<std::shared_ptr<ThreddsCollection>>;

// Returns the path of an address on this server as clients see it, with the prefix of [web].
[[nodiscard]] std::string path_for_clients(const Request& request, std::string_view path);

// Returns /thredds/catalog.xml, which refers to the radar server.
[[nodiscard]] std::string thredds_top_xml(const Request& request);
// Returns /thredds/radarServer/catalog.xml.
[[nodiscard]] std::string thredds_catalog_xml(const Request& request,
                                              const ThreddsCollections& collections);
// Returns {ds}/dataset.xml. `oldest` is the start of the oldest file.
[[nodiscard]] std::string thredds_dataset_xml(const Request& request,
                                              const ThreddsCollection& collection,
                                              const std::vector<ThreddsStation>& stations,
                                              std::optional<UtcTime> oldest);
// Returns {ds}/stations.xml. Stations whose place is unknown are left out.
[[nodiscard]] std::string thredds_stations_xml(const std::vector<ThreddsStation>& stations);
// Returns the answer to a query. `asked` is the text of the query.
[[nodiscard]] std::string thredds_result_xml(const Request& request,
                                             const ThreddsCollection& collection,
                                             std::string_view asked,
                                             const std::vector<ThreddsFile>& files);

}  // namespace stormcellar::web
