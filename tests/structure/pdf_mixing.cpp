// Densities with respect to different measures must not mix. Each CASE is right for two densities of one measure, which
// is the control, and must not compile when the second one is of another measure.

#include <lightswitch/core/pdf.hpp>

using lightswitch::AreaPdf;
using lightswitch::SolidAnglePdf;

#ifdef MUST_NOT_COMPILE
using Other = AreaPdf;
#else
using Other = SolidAnglePdf;
#endif

#if CASE == 1
bool order(SolidAnglePdf pdf, Other other) { return pdf < other; }
#elif CASE == 2
bool equality(SolidAnglePdf pdf, Other other) { return pdf == other; }
#elif CASE == 3
float weight(SolidAnglePdf pdf, Other other) { return power_heuristic(pdf, other); }
#elif CASE == 4
void assignment(SolidAnglePdf pdf, Other other) { pdf = other; }
#elif CASE == 5
AreaPdf conversion(Other pdf) { return to_area(pdf, 1.0f, 1.0f); }
#elif CASE == 6
// Densities that really are to be added (of one measure) say so by their values; there is no operator for it.
#ifdef MUST_NOT_COMPILE
auto sum(SolidAnglePdf pdf, Other other) { return pdf + other; }
#else
auto sum(SolidAnglePdf pdf, Other other) { return SolidAnglePdf{pdf.value + other.value}; }
#endif
#elif CASE == 7
double ratio(SolidAnglePdf pdf, Other other) { return pdf / other; }
#else
#error "CASE must be 1 to 7"
#endif
