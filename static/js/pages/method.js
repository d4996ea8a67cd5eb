// A method page.

import { offerCopies } from "../lib/copy.js";

offerCopies(document);
