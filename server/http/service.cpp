#include "server/http/service.h"

namespace toile {

Router make_router(Service& service) {
  Router router;
  add_asset_routes(router, service);
  add_job_routes(router, service);
  add_result_routes(router, service);
  add_library_routes(router);
  add_health_routes(router, service);
  return router;
}

Router make_health_router(Service& service) {
  Router router;
  add_health_routes(router, service);
  return router;
}

}  // namespace toile
