#include "run.hpp"

template lightswitch::program::Rendered lightswitch::program::run(const AnyScene&, const PathTracerNee&, const Job&);
