"""Tables, labels and paths of reports, whatever they report on."""
