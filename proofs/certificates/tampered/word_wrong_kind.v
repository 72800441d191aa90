(* kickdrift word "K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)" --lambda1 12 --h 1 --certificate word_wrong_kind.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary WordCertificate.

(** kind, the letters, then h, lambda1, lambda2. *)
Theorem kickdrift_word :
  word_verdict Elliptic [K All [1 # 6]; D (1 # 2); K All [2 # 3; -1 # 36]; D (1 # 2); K All [1 # 6]] (1 / 1) (12 / 1) (0 / 1).
Proof. certify_word (1 # 1) (12 # 1) (0 # 1). Qed.
Print Assumptions kickdrift_word.
