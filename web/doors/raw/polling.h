// web/doors/raw/polling.h -- sends the files that GR2Analyst, GRLevel2 and others poll
// (docs/web/raw.md).
//
//   /nexrd2/config.cfg and grlevel2.cfg   the name of the lists, and a line for each station
//   /nexrd2/STATION/dir.list              a line "SIZE NAME" for each of the newest volumes, the
//                                         newest last
//   /nexrd2/STATION/NAME                  a volume's bytes
//
// Threads   Many threads may use it.
#pragma once

#include <memory>

#include "web/data/raw/raw_files.h"
#include "web/http/door.h"

namespace stormcellar::web {

struct PollingOptions {
    std::size_t most_listed = 100;
};

class PollingDoor final : public Door {
  public:
    explicit PollingDoor(std::shared_ptr<RawFiles> files, PollingOptions options = {})
        : files_(std::move(files)), options_(options) {}
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    [[nodiscard]] Answer configuration(const Request& request) const;
    [[nodiscard]] Answer list_of(const Request& request, std::string_view station) const;
    std::shared_ptr<RawFiles> files_;
    PollingOptions options_;
};

}  // namespace stormcellar::web
