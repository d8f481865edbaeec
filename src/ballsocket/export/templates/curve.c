/* A quantity as piecewise polynomials of d, with `density` pieces from each power of two to the next. A row has the
   origin of a piece and the coefficients in d less the origin, the highest power first; `out` has the quantity and
   three derivatives. Below the low end it is a power of d, without contact 0, and beyond the high end NaN. */
typedef struct {
    double low, high;
    int first, density, pieces, terms;
    const double *rows;
} curve;

static void along_curve(const curve *c, double d, double out[4])
{
    const int below = d < c->low;
    const double inside = below ? c->low : d;
    const double *row;
    double place, power, value = 0.0, slope = 0.0, bend = 0.0, twist = 0.0;
    int octave, piece, term;
    if (d <= 0.0 || !(d <= c->high)) {
        out[0] = out[1] = out[2] = out[3] = d <= 0.0 ? 0.0 : NAN;
        return;
    }
    piece = (int)(2 * c->density * frexp(inside, &octave));
    piece += c->density * octave - c->first;
    row = c->rows + (piece < c->pieces ? piece : c->pieces - 1) * c->terms;
    place = inside - row[0];
    for (term = 1; term < c->terms; term++) {
        twist = twist * place + bend;
        bend = bend * place + slope;
        slope = slope * place + value;
        value = value * place + row[term];
    }
    out[0] = value;
    out[1] = slope;
    out[2] = 2.0 * bend;
    out[3] = 6.0 * twist;
    if (below) {
        power = slope * c->low / value;
        out[0] = value * pow(d / c->low, power);
        out[1] = power * out[0] / d;
        out[2] = (power - 1.0) * out[1] / d;
        out[3] = (power - 2.0) * out[2] / d;
    }
}
