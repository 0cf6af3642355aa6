// web/http/door.h -- what answers below one path, and how a request finds it.
//
// Threads   The server calls a door from many threads at once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "web/http/answer.h"
#include "web/http/request.h"
#include "web/http/work_queue.h"

namespace stormcellar::web {

class Door {
  public:
    virtual ~Door() = default;
    // Returns the answer if that takes well under a millisecond: it is kept in memory, or a file is
    // opened. The thread that serves all connections calls it. None: a worker calls answer().
    virtual std::optional<Answer> answer_at_once(const Request& /*request*/) {
        return std::nullopt;
    }
    // Makes the answer, however long that takes. If it throws, the client gets 503.
    virtual Answer answer(const Request& request) = 0;
    // Returns the answer unless it must be computed for long. None: answer() makes it, called by
    // the workers for long answers. Only a door that has such workers needs it.
    virtual std::optional<Answer> answer_soon(const Request& request) { return answer(request); }

    // A door whose answers take long has workers of its own, which several doors may share: then
    // the other doors need not wait for them, and what they cannot take is answered with 503. Null:
    // the workers of the server. To be set before the server opens.
    void set_workers(std::shared_ptr<WorkQueue> workers) { workers_ = std::move(workers); }
    [[nodiscard]] const std::shared_ptr<WorkQueue>& workers() const { return workers_; }
    // The same for answers that answer_soon() leaves.
    void set_long_workers(std::shared_ptr<WorkQueue> workers) {
        long_workers_ = std::move(workers);
    }
    [[nodiscard]] const std::shared_ptr<WorkQueue>& long_workers() const { return long_workers_; }

  private:
    std::shared_ptr<WorkQueue> workers_, long_workers_;
};

// A door finds itself by the longest prefix of whole segments: "/s3" answers "/s3", "/s3/" and
// "/s3/a", not "/s3a". "/" answers what no other door does.
class Doors {
  public:
    void add(std::string prefix, std::shared_ptr<Door> door);
    // Never null once "/" was added.
    [[nodiscard]] std::shared_ptr<Door> find(std::string_view path) const;
    // The longest first; "/" is among them as "/".
    [[nodiscard]] std::vector<std::string> prefixes() const;
    // The workers that doors have of their own, each once.
    [[nodiscard]] std::vector<std::shared_ptr<WorkQueue>> workers() const;

  private:
    std::vector<std::pair<std::string, std::shared_ptr<Door>>> doors_;
};

}  // namespace stormcellar::web
