// web/doors/thredds/thredds.h -- the THREDDS radar server for Siphon and the IDV (docs/web/raw.md).
//
//   /thredds/radarServer/catalog.xml            the data sets
//   /thredds/radarServer/{ds}/dataset.xml       one data set: variables, coverage
//   /thredds/radarServer/{ds}/stations.xml      its stations; {ds}?station=all, too
//   /thredds/radarServer/{ds}?stn=&time=...     its files (web/doors/thredds/query.h)
//   /thredds/fileServer/{ds}/...                the bytes of a file
//
// A query that cannot be answered gets the status 200 and a sentence as text/plain, because THREDDS
// clients recognize errors by that. All other answers have true status codes. Answers of
// radarServer close the connection, because Siphon opens one for each catalog and leaves closing to
// Python's garbage collector.
//
// Threads   Many threads may use it.
#pragma once

#include <memory>

#include "web/data/raw/raw_files.h"
#include "web/doors/thredds/answers.h"
#include "web/doors/thredds/query.h"
#include "web/http/door.h"

namespace stormcellar::web {

struct ThreddsOptions {
    ThreddsConfig config = WebConfig::usual_thredds();
    std::size_t most_results = 10'000;  // of one query; beyond that, the answer is a sentence
};

class ThreddsDoor final : public Door {
  public:
    explicit ThreddsDoor(const std::shared_ptr<RawFiles>& files, ThreddsOptions options = {});
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // A data set, and the segments of the path after the data set's own path.
    struct Found {
        std::shared_ptr<ThreddsCollection> collection;  // null: there is none
        std::vector<std::string_view> rest;
    };
    [[nodiscard]] Found find(std::vector<std::string_view> segments) const;
    [[nodiscard]] bool is_denied(std::string_view path) const;
    [[nodiscard]] Answer radar_answer(const Request& request,
                                      const std::vector<std::string_view>& segments) const;
    [[nodiscard]] Answer file_answer(const Request& request,
                                     const std::vector<std::string_view>& segments) const;
    [[nodiscard]] Answer query_answer(const Request& request, ThreddsCollection& collection) const;
    [[nodiscard]] Result<std::vector<ThreddsFile>> files_of(ThreddsCollection& collection,
                                                            const ThreddsQuery& query) const;

    const ThreddsOptions options_;
    ThreddsCollections collections_;
};

}  // namespace stormcellar::web
