/* Logarithm of a quantity as piecewise polynomials of ln d, the highest power first; `out` has the quantity and three
   derivatives. Below the shallowest d it is a power of d, without contact 0, and beyond the deepest d NaN. */
typedef struct {
    double shallowest, deepest, first, density;
    int pieces, terms;
    const double *rows;
} curve;

static void along_curve(const curve *c, double d, double out[4])
{
    const int below = d < c->shallowest;
    const double *row;
    double along, place, value = 0.0, slope = 0.0, bend = 0.0, twist = 0.0, p, q, r, scaled;
    int piece, term;
    if (d <= 0.0 || !(d <= c->deepest)) {
        out[0] = out[1] = out[2] = out[3] = d <= 0.0 ? 0.0 : NAN;
        return;
    }
    along = (log(below ? c->shallowest : d) - c->first) * c->density;
    piece = (int)along;
    piece = piece < 0 ? 0 : piece >= c->pieces ? c->pieces - 1 : piece;
    place = 2.0 * (along - piece) - 1.0;
    row = c->rows + piece * c->terms;
    for (term = 0; term < c->terms; term++) {
        twist = twist * place + bend;
        bend = bend * place + slope;
        slope = slope * place + value;
        value = value * place + row[term];
    }
    p = 2.0 * c->density * slope;
    q = below ? 0.0 : 8.0 * c->density * c->density * bend;
    r = below ? 0.0 : 48.0 * c->density * c->density * c->density * twist;
    scaled = exp(value);
    if (below)
        scaled *= pow(d / c->shallowest, p);
    out[0] = scaled;
    out[1] = scaled * p / d;
    out[2] = (out[1] * (p - 1.0) + scaled * q / d) / d;
    out[3] = scaled / d / d / d * (p * (p - 1.0) * (p - 2.0) + 3.0 * q * (p - 1.0) + r);
}
