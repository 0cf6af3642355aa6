// web/doors/index/index.h -- the index page at "/", its style at "/index.css", its script at
// "/index.mjs", and the answer to an address that no other door serves.
//
// The page (index.html) links to the doors and shows how programs connect, with addresses to copy.
// Its script asks /api/v1 for stations and mosaics. Style and script are separate files, since the
// Content-Security-Policy allows neither within the page. index.html has these marks:
//
//   <!--if /api/v1 !/zarr--> ... <!--end-->   a part that is left out unless the server has the
//                                             first door and lacks the second
//   {{base}} {{path}} {{host}}                the server's address, its path, and the address
//                                             without "http://"
//   {{bucket}} {{version}}                    the bucket of "/s3", and the version of the program
//
// Threads   Many threads may use it.
// Errors    404 for every other path.
#pragma once

#include <string>
#include <vector>

#include "web/http/door.h"

namespace stormcellar::web {

class IndexDoor final : public Door {
  public:
    // `doors` are Doors::prefixes().
    IndexDoor(const std::vector<std::string>& doors, std::string bucket);
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    const std::string page_;  // with the parts of these doors
    const std::string bucket_;
};

}  // namespace stormcellar::web
