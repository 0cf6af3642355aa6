// web/doors/thredds/answers.h -- the catalogs of the THREDDS radar server, as XML.
//
// They are of InvCatalog 1.0. Bases of services are paths of this server, so that a client that
// reached it by https stays there.
//
// Threads   Pure functions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "web/doors/thredds/collection.h"

namespace stormcellar::web {

using ThreddsCollections = std::vector<std::shared_ptr<ThreddsCollection>>;

// Returns the path of an address below this server, as clients see it: with the prefix of [web].
[[nodiscard]] std::string path_for_clients(const Request& request, std::string_view path);

// /thredds/catalog.xml: a reference to the radar server.
[[nodiscard]] std::string thredds_top_xml(const Request& request);
// /thredds/radarServer/catalog.xml
[[nodiscard]] std::string thredds_catalog_xml(const Request& request,
                                              const ThreddsCollections& collections);
// {ds}/dataset.xml. `oldest`: the start of the oldest file.
[[nodiscard]] std::string thredds_dataset_xml(const Request& request,
                                              const ThreddsCollection& collection,
                                              const std::vector<ThreddsStation>& stations,
                                              std::optional<UtcTime> oldest);
// {ds}/stations.xml. Stations whose place is not known are left out.
[[nodiscard]] std::string thredds_stations_xml(const std::vector<ThreddsStation>& stations);
// The answer to a query. `asked` is the query as text.
[[nodiscard]] std::string thredds_result_xml(const Request& request,
                                             const ThreddsCollection& collection,
                                             std::string_view asked,
                                             const std::vector<ThreddsFile>& files);

}  // namespace stormcellar::web
