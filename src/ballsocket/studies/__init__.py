"""Studies: one joint varied along named axes, pressed by any model, labelled, stored and resumed."""
