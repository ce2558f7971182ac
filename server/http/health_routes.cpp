#include "server/http/service.h"

#include <nlohmann/json.hpp>

namespace toile {

void add_health_routes(Router& router, Service& service) {
  router.add({"GET",
              "/healthz",
              [&service](const HttpRequest&) {
                bool store_works = true;
                try {
                  service.store.check();
                } catch (const StoreError&) {
                  store_works = false;
                }
                const bool dispatcher_works = service.dispatcher.is_healthy();
                const auto word = [](bool well) { return well ? "ok" : "failing"; };
                const bool well = store_works && dispatcher_works;
                HttpResponse response;
                response.status = well ? 200 : 503;
                nlohmann::json document;
                document["status"] = word(well);
                document["version"] = TOILE_VERSION;
                document["checks"]["store"] = word(store_works);
                document["checks"]["dispatcher"] = word(dispatcher_works);
                response.body = document.dump() + "\n";
                response.headers = {{"Cache-Control", "no-store"}};
                return response;
              },
              {}});
}

}  // namespace toile
