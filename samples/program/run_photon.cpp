#include "run_method.hpp"

template lightswitch::program::Rendered lightswitch::program::run(const AnyScene&, const PhotonMapping&, const Job&);
template lightswitch::Estimator lightswitch::program::make_estimator(const AnyScene&, const PhotonMapping&,
                                                                     const Settings&);
