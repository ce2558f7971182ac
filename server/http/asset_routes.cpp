#include "server/http/problem_response.h"
#include "server/http/service.h"
#include "server/store/digest.h"

#include <nlohmann/json.hpp>

namespace toile {

void add_asset_routes(Router& router, Service& service) {
  router.add(
      {"POST",
       "/v1/assets",
       [&service](const HttpRequest& request) {
         if (request.body.empty()) throw HttpProblem(422, "empty_asset", "An asset must have a byte at least.");
         const std::string digest = sha256_hex(request.body);
         const bool created = service.store.put_asset(digest, request.body, service.clock());
         HttpResponse response;
         response.status = created ? 201 : 200;
         response.body = nlohmann::json{{"asset", "sha256:" + digest}, {"bytes", request.body.size()}}.dump() + "\n";
         return response;
       },
       {kAssetLimit, false}});
}

}  // namespace toile
