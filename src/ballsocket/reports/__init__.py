"""Results become pictures, tables and pages. Nothing is solved here."""
