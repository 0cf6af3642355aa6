// web/doors/index/index.h -- the index page at "/", its style at "/index.css", and the answer to an
// address that no other door serves.
//
// Threads   As Door.
// Errors    404 for every other path.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "web/data/events/event_feed.h"
#include "web/data/grids/grids.h"
#include "web/doors/index/page.h"
#include "web/http/door.h"

namespace stormcellar::web {

struct IndexOptions {
    std::shared_ptr<Grids> grids;           // null: no cache
    std::shared_ptr<const EventFeed> feed;  // knows the stations; may be null
    std::vector<std::string> doors;         // Doors::prefixes()
    std::string bucket;
    std::size_t most_stations = 1000;
};

class IndexDoor final : public Door {
  public:
    explicit IndexDoor(IndexOptions options) : options_(std::move(options)) {}
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    [[nodiscard]] IndexFacts facts(const Request& request) const;
    const IndexOptions options_;
};

}  // namespace stormcellar::web
