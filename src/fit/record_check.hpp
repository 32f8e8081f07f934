// Compares the records of a fit with the run at its start, before the first minimisation, and with that of the
// estimates.
#pragma once

#include <string>
#include <vector>

#include "fit/forward_model.hpp"
#include "fit/residuals.hpp"

namespace traverse::fit {

/// What is probably wrong with the sign, the clock or the offset of a record, one sentence each. InputError for a
/// record that no values within the bounds can explain, because its unit or its clock is another. The clocks must be
/// aligned.
std::vector<std::string> doubts_about_records(const options::Fit& fit, const ForwardModel& model,
                                              const Residuals& residuals);
/// The same sentences for the computed response of other unknowns u: at the estimates, what no fit has explained.
std::vector<std::string> doubts_that_remain(const options::Fit& fit, const ForwardModel& model,
                                            const Residuals& residuals, const std::vector<double>& response,
                                            const Eigen::VectorXd& u);

}  // namespace traverse::fit
