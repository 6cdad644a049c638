#include "run_method.hpp"

template lightswitch::program::Rendered lightswitch::program::run(const AnyScene&, const Silhouette&, const Job&);
template lightswitch::Estimator lightswitch::program::make_estimator(const AnyScene&, const Silhouette&,
                                                                     const Settings&);
