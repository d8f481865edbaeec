"""SVG pictures that several views share."""
