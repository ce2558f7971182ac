#include "server/http/problem_response.h"
#include "server/http/service.h"

#include <nlohmann/json.hpp>

namespace toile {

void add_health_routes(Router& router, Service& service) {
  router.add({"GET",
              "/healthz",
              [&service](const HttpRequest&) {
                long queued = 0;
                try {
                  service.store.check();
                  queued = service.store.queued_jobs();
                } catch (const StoreError&) {
                  throw HttpProblem(503, "store_failing", "The store does not answer.");
                }
                if (!service.dispatcher.is_healthy()) {
                  throw HttpProblem(503, "dispatcher_failing", "The workers have shown no sign of life of late.");
                }
                nlohmann::json document;
                document["status"] = "ok";
                document["version"] = TOILE_VERSION;
                document["queued"] = queued;
                HttpResponse response;
                response.body = document.dump() + "\n";
                response.headers = {{"Cache-Control", "no-store"}};
                return response;
              },
              {}});
}

}  // namespace toile
