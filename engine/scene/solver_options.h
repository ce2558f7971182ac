#pragma once
// The numbers that steer the solver. Defaults are the first seed's production setting (its sections 3 and 5).

namespace toile {

struct SolverOptions {
  double max_time_step = 1e-3;        ///< h_max [s]
  double simulated_time_limit = 6.0;  ///< [s]; a drape that is not at rest then has not converged
  double newton_tolerance = 1e-3;     ///< tau_n: norm of the momentum residual [kg·m/s]
  /// Newton goes on, up to newton_iterations, while the residual exceeds this fraction of h ‖M g‖ + min(‖M v‖, h ‖M
  /// g‖); 0: never, as the seed. An absolute tolerance alone lets a light or stiff mesh gain energy step by step, and
  /// what slides disregard its forces.
  double newton_momentum_fraction = 0.05;
  double cg_tolerance = 1e-2;      ///< tau_cg: relative residual
  int newton_iterations = 5;       ///< I_n
  int line_search_iterations = 5;  ///< I_ls, lengths tried: 1, 1/2, 1/4, …; twice as many after the first iteration
  int cg_iterations = 500;         ///< at most per linear solve
  double splitting_factor = 0.75;  ///< omega
  int steps_before_growth = 5;     ///< I_s successful steps before h grows
  double air_drag = 5.0;           ///< alpha [1/s]
  double relaxation_time = 0.1;    ///< window of the initial relaxation [s]; 0: none
  double relaxation_stiffness = 1e-2;   ///< factor on fabric stiffness at its start, rising to 1 linearly
  double relaxation_step_divisor = 16;  ///< h starts at h_max over this
  double weight_ramp_time = 0;          ///< weight grows linearly from none to whole in this time [s]
  double contact_stiffness = 1e2;       ///< of point repulsion [N/m]
  double contact_distance = 0;          ///< cloth to cloth [m]; 0: from thickness and edge length
  double body_offset = 0;               ///< cloth's mid-surface to body [m]; 0: from thickness and edge length
  double rest_kinetic_energy = 1e-8;    ///< early stop: 99th percentile of nodal kinetic energy under this [J] …
  double rest_window = 0.1;             ///< … throughout this window [s]
  double rest_residual = 0.05;  ///< … and the rms net force on free vertices under this share of nodal weight;
                                ///< 0: not asked (the seed as written, which takes slow falling for rest)
  bool early_stop = true;
  bool gravity = true;
  int threads = 0;  ///< 0: all. The result does not depend on it.
};

}  // namespace toile
