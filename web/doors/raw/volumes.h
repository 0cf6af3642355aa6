// web/doors/raw/volumes.h -- lists and sends raw volumes by station and name (docs/web/raw.md).
//
//   /volumes/                the stations
//   /volumes/STATION/        its volumes, the newest first; ?from= &to= &limit=
//   /volumes/STATION/NAME    a volume's bytes
//
// Lists are JSON, or a page of links if Accept prefers HTML.
//
// Threads   Many threads may use it.
#pragma once

#include <memory>

#include "web/data/raw/raw_files.h"
#include "web/http/door.h"

namespace stormcellar::web {

class VolumesDoor final : public Door {
  public:
    explicit VolumesDoor(std::shared_ptr<RawFiles> files) : files_(std::move(files)) {}
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    [[nodiscard]] Answer stations_answer(const Request& request) const;
    [[nodiscard]] Answer list_answer(const Request& request, std::string_view station) const;
    std::shared_ptr<RawFiles> files_;
};

}  // namespace stormcellar::web
