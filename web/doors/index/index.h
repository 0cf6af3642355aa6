// web/doors/index/index.h -- the door for the index page at "/", its style "/index.css" and its
// script "/index.mjs". It also answers requests for addresses that no other door has.
//
// The page (index.html) links to the other doors, and shows how programs connect, with addresses to
// copy. Its script asks /api/v1 for stations and mosaics. Style and script are separate files,
// because the Content-Security-Policy does not allow them in the page. index.html has these marks:
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
    const std::string page_;  // without the parts for doors that the server lacks
    const std::string bucket_;
};

}  // namespace stormcellar::web
